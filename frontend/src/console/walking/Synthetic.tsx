/** Says of walks, models and figures that no person walked them. */
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Walking.module.css";

export function Synthetic(): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.synthetic}>
      <Icon name="body" size={14} />
      {t("walking.synthetic")}
    </span>
  );
}
