/**
 * The session is held: in place of the step, what to do for the participant and the ways to
 * continue.
 */
import { Button } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
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
  const can = usePermissions();
  const values = { score: held.score, instrument: held.instrument, limit: held.stop_at };
  return (
    <section className={classes.card} role="alert">
      <h2 className={classes.title}>
        <Icon name="alert" size={36} />
        {t("held.title")}
      </h2>
      <p className={classes.reason}>{t(held.is_rise ? "held.rise" : "held.score", values)}</p>
      <p>{t("held.body")}</p>
      {can("run") && (
        <div className={classes.actions}>
          <Button
            size="lg"
            color="red"
            leftSection={<Icon name="stop" />}
            onClick={() => onReasonNeeded("abort")}
          >
            {t("held.end")}
          </Button>
          <Button size="lg" variant="default" onClick={() => onReasonNeeded("override_stop")}>
            {t("do.override_stop")}
          </Button>
          <Button variant="subtle" color="red" onClick={() => onReasonNeeded("withdraw")}>
            {t("held.withdraw")}
          </Button>
        </div>
      )}
    </section>
  );
}

interface RefusedCardProps {
  readonly refusal: NonNullable<SessionView["refusal"]>;
  readonly onReasonNeeded: (type: Reasoned) => void;
}

/** The participant does not want to take part: nothing continues before somebody has decided. */
export function RefusedCard({ refusal, onReasonNeeded }: RefusedCardProps): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  return (
    <section className={classes.card} role="alert">
      <h2 className={classes.title}>
        <Icon name="alert" size={36} />
        {t("refused.title")}
      </h2>
      {refusal.at !== null && (
        <p className={classes.reason}>
          {t("refused.at", { time: timeOfDay(refusal.at, language), number: refusal.step + 1 })}
        </p>
      )}
      <p>{t("refused.body")}</p>
      {can("run") && (
        <div className={classes.actions}>
          <Button
            size="lg"
            color="red"
            leftSection={<Icon name="stop" />}
            onClick={() => onReasonNeeded("withdraw")}
          >
            {t("refused.end")}
          </Button>
          <Button size="lg" variant="default" onClick={() => onReasonNeeded("reopen_consent")}>
            {t("do.reopen_consent")}
          </Button>
        </div>
      )}
    </section>
  );
}
