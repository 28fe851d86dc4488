/** How far a fit is. */
import { Progress } from "@mantine/core";
import type { ModelListed } from "@shared/api/walking";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Walking.module.css";

interface FitProgressProps {
  readonly model: ModelListed;
  readonly named?: boolean;
}

export function FitProgress({ model, named }: FitProgressProps): JSX.Element | null {
  const { t } = useTexts();
  if (model.state === "ready" || model.state === "failed") return null;
  const {
    stage,
    maps,
    maps_total: total,
  } = model.progress ?? {
    stage: "waiting" as const,
    maps: 0,
    maps_total: 0,
  };
  const told =
    total > 0 && stage !== "blending"
      ? t("walking.stage.maps", { maps, total })
      : t(`walking.stage.${stage}`);
  return (
    <div role="status">
      {named === true && <strong>{t("walking.fitting", { title: model.title })}</strong>}
      <Progress
        value={total > 0 ? (100 * maps) / total : 0}
        animated={model.state === "fitting"}
        color={model.state === "fitting" ? "petrol" : "gray"}
        aria-label={t("walking.progress", { title: model.title })}
        my={4}
      />
      <span className={classes.sub}>
        {model.state === "stopped" ? t("walking.state.stopped.at", { maps, total }) : told}
      </span>
    </div>
  );
}
