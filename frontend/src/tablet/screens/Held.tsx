/** A stop rule holds the session: calm words, no reason, and nothing to press. */
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./screens.module.css";

export function Held(): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm} role="status">
      <span className={classes.breathing}>
        <Mark size={64} />
      </span>
      <h1 className={classes.calmTitle}>{t("held.wait.title")}</h1>
      <p className={classes.calmText}>{t("held.wait.body")}</p>
    </div>
  );
}
