/** What the boxes say in colours, in words: the last touch and what it was judged to be. */
import type { PoseTouch } from "@shared/api/poses";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import classes from "./Live3d.module.css";

export function LastTouch({ touch }: { readonly touch: PoseTouch | null }): JSX.Element {
  const { t } = useTexts();
  if (touch === null) return <span className={classes.last}>{t("live3d.last.none")}</span>;
  if (touch.kind === "completion") {
    return <span className={classes.last}>{t("live3d.completed")}</span>;
  }
  const box = touch.surface?.split("/")[1] ?? "";
  const told = t("live3d.touch", {
    part: (touch.part ?? "").replace(/([a-z])([A-Z])/g, "$1 $2"),
    surface: t(`live3d.surface.${touch.kind}`, { box }),
    effect: t(EFFECTS[touch.effect] ?? "live3d.effect.none"),
  });
  return (
    <span className={classes.last}>
      {t("live3d.last")} <b>{told}</b>
    </span>
  );
}

const EFFECTS: Readonly<Record<string, Key>> = {
  green: "live3d.effect.green",
  target: "live3d.effect.target",
  side: "live3d.effect.side",
  out_of_order: "live3d.effect.out_of_order",
  wrong_part: "live3d.effect.wrong_part",
  early: "live3d.effect.early",
};
