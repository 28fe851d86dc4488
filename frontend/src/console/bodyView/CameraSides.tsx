/** Buttons that place the camera of a picture in 3-D. */
import type { CameraSide } from "@shared/stage/figure";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./BodyViewer.module.css";

const SIDES: readonly CameraSide[] = ["corner", "front", "side", "back", "top"];

interface CameraSidesProps {
  readonly onLook: (from: CameraSide) => void;
}

export function CameraSides({ onLook }: CameraSidesProps): JSX.Element {
  const { t } = useTexts();
  return (
    <fieldset className={classes.sides}>
      <legend className="visually-hidden">{t("stage.look")}</legend>
      {SIDES.map((from) => (
        <button key={from} type="button" className={classes.side} onClick={() => onLook(from)}>
          {t(`stage.look.${from}`)}
        </button>
      ))}
    </fieldset>
  );
}
