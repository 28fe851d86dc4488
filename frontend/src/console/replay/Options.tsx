/** What is shown on the stage, and from where. */
import { Checkbox } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import classes from "./Replay.module.css";
import type { Lane } from "./useLane";

interface OptionsProps {
  readonly lanes: readonly Lane[];
  readonly ghost: boolean;
  readonly boxes: boolean;
  readonly onGhost: (ghost: boolean) => void;
  readonly onBoxes: (boxes: boolean) => void;
  readonly camera: ReactNode;
}

export function Options(props: OptionsProps): JSX.Element {
  const { lanes, ghost, boxes, onGhost, onBoxes, camera } = props;
  const { t } = useTexts();
  const isFull = lanes.some(({ movement }) => movement?.avatar != null);
  const hasBoxes = lanes.some(({ replay }) => replay.surfaces.length > 0);
  return (
    <div className={classes.options}>
      {camera}
      <div className={classes.shown}>
        {isFull && (
          <Checkbox
            size="xs"
            label={t("replay.ghost")}
            checked={ghost}
            onChange={(event) => onGhost(event.currentTarget.checked)}
          />
        )}
        {hasBoxes && (
          <Checkbox
            size="xs"
            label={t("replay.boxes")}
            checked={boxes}
            onChange={(event) => onBoxes(event.currentTarget.checked)}
          />
        )}
      </div>
    </div>
  );
}
