/**
 * The session is held: in place of the step, what to do for the participant and the ways to
 * continue.
 */
import { Button } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import type { Reasoned } from "../session/action";
import classes from "./HeldCard.module.css";

interface HeldCardProps {
  readonly held: NonNullable<SessionView["held"]>;
  readonly onReasonNeeded: (type: Reasoned) => void;
}

/** A stop rule was met. */
export function HeldCard({ held, onReasonNeeded }: HeldCardProps): JSX.Element {
  const { t } = useTexts();
  const values = { score: held.score, instrument: held.instrument, limit: held.stop_at };
  return (
    <Hold
      title={t("held.title")}
      reason={t(held.is_rise ? "held.rise" : "held.score", values)}
      body={t("held.body")}
      end={{ title: t("held.end"), action: "abort" }}
      goOn={{ title: t("do.override_stop"), action: "override_stop" }}
      onReasonNeeded={onReasonNeeded}
    >
      <Button variant="subtle" color="red" onClick={() => onReasonNeeded("withdraw")}>
        {t("held.withdraw")}
      </Button>
    </Hold>
  );
}

interface RefusedCardProps {
  readonly refusal: NonNullable<SessionView["refusal"]>;
  readonly onReasonNeeded: (type: Reasoned) => void;
}

/** The participant does not want to take part: nothing continues before somebody has decided. */
export function RefusedCard({ refusal, onReasonNeeded }: RefusedCardProps): JSX.Element {
  const { t, language } = useTexts();
  const time = refusal.at === null ? null : timeOfDay(refusal.at, language);
  return (
    <Hold
      title={t("refused.title")}
      reason={time === null ? null : t("refused.at", { time, number: refusal.step + 1 })}
      body={t("refused.body")}
      end={{ title: t("refused.end"), action: "withdraw" }}
      goOn={{ title: t("do.reopen_consent"), action: "reopen_consent" }}
      onReasonNeeded={onReasonNeeded}
    />
  );
}

interface Way {
  readonly title: string;
  readonly action: Reasoned;
}

interface HoldProps {
  readonly title: string;
  readonly reason: string | null;
  readonly body: string;
  readonly end: Way;
  readonly goOn: Way;
  readonly onReasonNeeded: (type: Reasoned) => void;
  /** Further ways, for those who may run sessions. */
  readonly children?: ReactNode;
}

function Hold(props: HoldProps): JSX.Element {
  const { title, reason, body, end, goOn, onReasonNeeded, children } = props;
  const can = usePermissions();
  return (
    <section className={classes.card} role="alert">
      <h2 className={classes.title}>
        <Icon name="alert" size={36} />
        {title}
      </h2>
      {reason !== null && <p className={classes.reason}>{reason}</p>}
      <p>{body}</p>
      {can("run") && (
        <div className={classes.actions}>
          <Button
            size="lg"
            color="red"
            leftSection={<Icon name="stop" />}
            onClick={() => onReasonNeeded(end.action)}
          >
            {end.title}
          </Button>
          <Button size="lg" variant="default" onClick={() => onReasonNeeded(goOn.action)}>
            {goOn.title}
          </Button>
          {children}
        </div>
      )}
    </section>
  );
}
