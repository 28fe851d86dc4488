/** Screens without a task: waiting, held by a stop rule, and finished. */
import type { TabletState } from "@shared/api/types";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Prose } from "./Prose";
import classes from "./screens.module.css";

/** Nothing to do here at the moment: say so calmly, and what comes. */
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

/** A stop rule holds the session: calm words, no reason, and nothing to press. */
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

/** The end of the visit. */
export function Finished({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm}>
      <Mark size={64} />
      <h1 className={classes.calmTitle}>{t("finished.title")}</h1>
      <div className={classes.calmText}>
        {state.text === null ? t("finished.body") : <Prose text={state.text} />}
      </div>
    </div>
  );
}
