/** Nothing to do here at the moment: say so calmly, and what comes. */
import type { TabletState } from "@shared/api/types";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Prose } from "./Prose";
import classes from "./screens.module.css";

export function Waiting({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm} aria-live="polite">
      <span className={classes.breathing}>
        <Mark size={64} />
      </span>
      <h1 className={classes.calmTitle}>{t("waiting.title")}</h1>
      <div className={classes.calmText}>
        {state.text === null ? t("waiting.body") : <Prose text={state.text} />}
      </div>
      {state.next !== null && (
        <p className={classes.next}>
          <span className={classes.nextLabel}>{t("waiting.next")}</span>
          {state.next}
        </p>
      )}
    </div>
  );
}
