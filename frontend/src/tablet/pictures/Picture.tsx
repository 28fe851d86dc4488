/** A picture of the instructions by its name, with words for those who do not see it. */
import { isPicture, type PictureName } from "@shared/pictures";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Picture.module.css";
import { Equipment, FootBoxes, HandBoxes, Mirror, TPose } from "./scenes";

const SCENES: Readonly<Record<PictureName, () => JSX.Element>> = {
  equipment: Equipment,
  t_pose: TPose,
  mirror: Mirror,
  hand_boxes: HandBoxes,
  foot_boxes: FootBoxes,
};

export function Picture({ name }: { readonly name: string }): JSX.Element | null {
  const { t } = useTexts();
  if (!isPicture(name)) return null;
  const Scene = SCENES[name];
  return (
    <svg
      className={classes.picture}
      viewBox="0 0 480 246"
      role="img"
      aria-label={t(`picture.${name}`)}
    >
      <Scene />
    </svg>
  );
}
