/** Screens without a task: waiting, held by a stop rule, not taking part, and finished. */
import { Button } from "@mantine/core";
import type { TabletState } from "@shared/api/types";
import { Mark } from "@shared/ui/Mark";
import type { JSX, ReactNode } from "react";
import type { Refusal } from "../drafts/refusal";
import { useTexts } from "../i18n";
import { Prose } from "./Prose";
import classes from "./screens.module.css";

interface CalmProps {
  readonly title: string;
  readonly children: ReactNode;
  /** What comes next, where that is known. */
  readonly next?: string | null;
}

/** A screen with nothing to press. */
function Calm({ title, children, next = null }: CalmProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm} role="status">
      <span className={classes.breathing}>
        <Mark size={64} />
      </span>
      <h1 className={classes.calmTitle}>{title}</h1>
      <div className={classes.calmText}>{children}</div>
      {next !== null && (
        <p className={classes.next}>
          <span className={classes.nextLabel}>{t("waiting.next")}</span>
          {next}
        </p>
      )}
    </div>
  );
}

/**
 * Nothing to press at the moment: say so calmly, with what comes next, or show the step's own text.
 */
export function Waiting({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  const title = state.is_own_text && state.title !== null ? state.title : t("waiting.title");
  return (
    <Calm title={title} next={state.next}>
      {state.text === null ? t("waiting.body") : <Prose text={state.text} />}
    </Calm>
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
    <Calm title={state.title ?? t("waiting.title")} next={state.next}>
      {t(`elsewhere.${where}`)}
    </Calm>
  );
}

/** A stop rule holds the session: calm words, no reason, and nothing to press. */
export function OnHold(): JSX.Element {
  const { t } = useTexts();
  return <Calm title={t("held.wait.title")}>{t("held.wait.body")}</Calm>;
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
