/** Screens without a task: waiting, held by a stop rule, not taking part, and finished. */
import { Button } from "@mantine/core";
import type { TabletState } from "@shared/api/types";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import type { Refusal } from "../drafts/refusal";
import { useTexts } from "../i18n";
import { Prose } from "./Prose";
import classes from "./screens.module.css";

/**
 * Nothing to press at the moment: say so calmly, with what comes next, or show the step's own text.
 */
export function Waiting({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm} aria-live="polite">
      <span className={classes.breathing}>
        <Mark size={64} />
      </span>
      <h1 className={classes.calmTitle}>
        {state.is_own_text && state.title !== null ? state.title : t("waiting.title")}
      </h1>
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

interface ElsewhereProps {
  readonly state: TabletState;
  readonly where: "in_headset" | "oral";
}

/** A form that the participant answers inside the headset, or aloud: say where to look. */
export function AnsweredElsewhere({ state, where }: ElsewhereProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm} role="status">
      <span className={classes.breathing}>
        <Mark size={64} />
      </span>
      <h1 className={classes.calmTitle}>{state.title ?? t("waiting.title")}</h1>
      <p className={classes.calmText}>{t(`elsewhere.${where}`)}</p>
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
export function OnHold(): JSX.Element {
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

interface RefusedProps {
  readonly connected: boolean;
  readonly refusal: Refusal;
}

/**
 * The participant does not want to take part: the experimenter knows, and nothing else is asked.
 */
export function Refused({ connected, refusal }: RefusedProps): JSX.Element {
  const { t } = useTexts();
  const { waiting, failed, setRefused } = refusal;
  const stuck = failed || !connected;
  // Refused on this tablet, but the experimenter has not been notified yet.
  const key = waiting?.refused !== true ? "told" : stuck ? "untold" : "telling";
  return (
    <div className={classes.calm} role="status">
      <Mark size={64} />
      <h1 className={classes.calmTitle}>{t("refused.title")}</h1>
      <p className={classes.calmText}>
        {t(`refused.${key}`)} {t("refused.free")}
      </p>
      <Button
        variant="subtle"
        color="gray"
        loading={waiting !== null && !stuck}
        onClick={() => setRefused(false)}
      >
        {t("refused.takeBack")}
      </Button>
    </div>
  );
}

/** The end of the session. */
export function Finished({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  const words = state.is_refused ? "finished.refused" : "finished";
  return (
    <div className={classes.calm}>
      <Mark size={64} />
      <h1 className={classes.calmTitle}>{t(`${words}.title`)}</h1>
      <div className={classes.calmText}>
        {state.text === null ? t(`${words}.body`) : <Prose text={state.text} />}
      </div>
    </div>
  );
}
