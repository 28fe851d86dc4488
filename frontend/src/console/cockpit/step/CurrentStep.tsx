/** The current step, and the one large button that moves the session forward. */

import { Button, Loader, Menu } from "@mantine/core";
import type { SessionView, Step } from "@shared/api/types";
import { latency } from "@shared/format";
import { isCrossing } from "@shared/session/steps";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { milliseconds } from "@shared/units";
import type { JSX } from "react";
import { changeWords } from "../../avatarChanges/words";
import { type Key as TextKey, useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { isForm, isTimed, stepIcon, stepName } from "../../steps";
import { Key } from "../../ui/Key";
import { Shortfalls } from "../../ui/Shortfalls";
import {
  COMMON_REASONS,
  currentStep,
  guidance,
  isBlocked,
  isConnected,
  lacksHeadset,
  primaryAction,
  type Reasoned,
} from "../session/action";
import type { useSession } from "../session/useSession";
import classes from "./CurrentStep.module.css";
import { HeightForm } from "./HeightForm";
import { NextParticipant } from "./NextParticipant";
import { Aloud, isAloud } from "./OperatorEntry";
import { PaperConsent } from "./PaperConsent";
import { PhaseClock } from "./PhaseClock";

interface CurrentStepProps {
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
  /** Before the start: whether the pre-flight is loaded and no check is open. */
  readonly isReady: boolean;
  readonly onReasonNeeded: (type: Reasoned) => void;
  readonly onEnterAnswers: () => void;
}

export function CurrentStep(props: CurrentStepProps): JSX.Element {
  const { session, live, isReady } = props;
  const { t } = useTexts();
  const step = currentStep(session);
  return (
    <section className={classes.card} data-tour="step" aria-live="polite">
      {step === null ? (
        <h2 className={classes.title}>
          {t(
            session.status === "planned" && !(isReady && hasDevices(session))
              ? "session.open"
              : `session.${session.status}`,
          )}
        </h2>
      ) : (
        <>
          <StepPosition session={session} step={step} />
          <h2 className={classes.title}>
            <Icon name={stepIcon(step)} size={28} />
            {t(stepName(step))}
          </h2>
        </>
      )}
      <p className={classes.guide}>
        {t(isAloud(session, step) ? "step.askAloud" : guidance(session))}
      </p>
      {session.end_reason != null && (
        <p className={classes.guide}>{t("session.endReason", { reason: session.end_reason })}</p>
      )}
      {lacksHeadset(session) && (
        <p id={REASON} className={classes.guide}>
          {t("step.noHeadset")}
        </p>
      )}
      {session.shortfalls !== null && session.shortfalls.length > 0 && (
        <div className={classes.notValid}>
          <Notice tone="warn" title={t("validity.title")}>
            {t("validity.body")}
            <Shortfalls found={session.shortfalls} />
          </Notice>
        </div>
      )}
      {step !== null && isTimed(step) && <PhaseClock session={session} store={live.store} />}
      {session.current?.status === "paused" && <PauseReason live={live} />}
      {isAloud(session, step) && <Aloud session={session} step={step} />}
      {step?.kind === "height" && session.allowed.includes("complete_step") ? (
        <HeightForm
          session={session}
          step={step.index}
          send={live.send}
          sending={live.sending}
          exceptions={<Exceptions {...props} />}
        />
      ) : (
        <div className={classes.actions} data-tour="next">
          <Primary {...props} />
          <Exceptions {...props} />
        </div>
      )}
    </section>
  );
}

const hasDevices = (session: SessionView): boolean =>
  isConnected(session, "tablet") && isConnected(session, "headset");

/** The id of the sentence that says why the large button is disabled. */
const REASON = "step-no-headset";

function StepPosition({ session, step }: { readonly session: SessionView; readonly step: Step }) {
  const texts = useTexts();
  const { t } = texts;
  const parts = [t("step.of", { number: step.index + 1, total: session.steps.length })];
  if (step.block !== null) {
    const blocks = new Set(session.steps.map((other) => other.block).filter((b) => b !== null));
    const number = [...blocks].indexOf(step.block) + 1;
    parts.push(t("step.block", { number, total: blocks.size }));
  }
  if (step.latency_ms !== null) {
    parts.push(t("step.latency", { latency: latency(milliseconds(step.latency_ms)) }));
  } else if (step.block !== null) parts.push(t("step.latencyHidden"));
  if (step.body !== null) parts.push(t("overview.body", { body: step.body }));
  if (step.until_completions != null) {
    const until = isCrossing(step) ? "road.until" : "practice.until";
    parts.push(t(until, { count: step.until_completions }));
  }
  if (step.avatar_changes != null) {
    const words = changeWords(texts, step.avatar_changes).join(" · ");
    parts.push(`${t("avatarChanges.inPhase")} ${words}`);
  }
  if (step.attempt > 1) parts.push(t("timeline.attempt", { number: step.attempt }));
  return (
    <div className={`${classes.kicker} numbers`}>
      {parts.map((part) => (
        <span key={part}>{part}</span>
      ))}
    </div>
  );
}

function Primary({ session, live, onEnterAnswers }: CurrentStepProps): JSX.Element | null {
  const { t } = useTexts();
  const can = usePermissions();
  if (session.ended_at !== null) return can("run") ? <NextParticipant session={session} /> : null;
  const action = primaryAction(session);
  const step = currentStep(session);
  if (action !== null) {
    const reason = isBlocked(session, action) ? t("step.noHeadset") : undefined;
    return (
      <Button
        size="lg"
        className={classes.primary ?? ""}
        leftSection={<Icon name={action.icon} />}
        rightSection={<Key name={t("keys.enter")} />}
        loading={live.sending}
        disabled={reason !== undefined}
        title={reason}
        aria-describedby={reason && REASON}
        onClick={() => live.send(action.command)}
      >
        {t(action.label)}
      </Button>
    );
  }
  if (session.allowed.includes("pause")) {
    return (
      <Button
        size="lg"
        variant="outline"
        className={classes.primary ?? ""}
        leftSection={<Icon name="pause" />}
        rightSection={<Key name="P" />}
        loading={live.stopping}
        onClick={() => live.send({ type: "pause" })}
      >
        {t("do.pause")}
      </Button>
    );
  }
  if (step?.kind === "consent" && session.allowed.includes("complete_step")) {
    return <PaperConsent session={session} step={step} live={live} />;
  }
  if (session.allowed.includes("resume") || step === null || !isForm(step)) return null;
  if (isAloud(session, step)) return null;
  return (
    <>
      <span className={classes.waiting}>
        <Loader size="sm" type="dots" />
        {t(whereAnswered(session, step))}
      </span>
      {session.allowed.includes("enter_answers") && (
        <Button
          variant="default"
          leftSection={<Icon name="form" size={18} />}
          onClick={onEnterAnswers}
        >
          {t("do.enterAnswers")}
        </Button>
      )}
    </>
  );
}

/** Where the participant answers a form, and whether that can happen now. */
function whereAnswered(session: SessionView, { forms }: Step): TextKey {
  if (forms === "headset") {
    return isConnected(session, "headset") ? "step.waitingForm.headset" : "step.noHeadset";
  }
  if (!isConnected(session, "tablet")) return "step.noTablet";
  const isWorn = isConnected(session, "headset") && session.phases.length > 0;
  return isWorn ? "step.waitingTablet.worn" : "step.waitingTablet";
}

const DANGERS = ["abort", "withdraw"] as const;

function Exceptions({ session, onReasonNeeded }: CurrentStepProps): JSX.Element | null {
  const { t } = useTexts();
  const may = (type: Reasoned): boolean => session.allowed.includes(type);
  const dangers = DANGERS.filter(may);
  return (
    <div className={classes.exceptions}>
      {may("redo") && (
        <Button
          variant="subtle"
          color="gray"
          px="sm"
          rightSection={<Key name="R" />}
          onClick={() => onReasonNeeded("redo")}
        >
          {t("do.redo")}
        </Button>
      )}
      {may("skip") && (
        <Button
          variant="subtle"
          color="gray"
          px="sm"
          rightSection={<Key name="S" />}
          onClick={() => onReasonNeeded("skip")}
        >
          {t("do.skip")}
        </Button>
      )}
      {dangers.length > 0 && (
        <Menu position="bottom-end" width={280} withInitialFocusPlaceholder={false}>
          <Menu.Target>
            <Button
              variant="subtle"
              color="red"
              px="sm"
              rightSection={<Icon name="down" size={14} />}
            >
              {t("do.end")}
            </Button>
          </Menu.Target>
          <Menu.Dropdown>
            {dangers.map((type) => (
              <Menu.Item key={type} onClick={() => onReasonNeeded(type)}>
                {t(`do.${type}`)}
              </Menu.Item>
            ))}
          </Menu.Dropdown>
        </Menu>
      )}
    </div>
  );
}

/**
 * Pausing is instant; the reason is entered afterwards, while the clock is paused, and stored as a
 * note.
 */
function PauseReason({ live }: { readonly live: ReturnType<typeof useSession> }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.hint}>
      <span>{t("pause.why")}</span>
      {COMMON_REASONS.pause.map((key) => (
        <Button
          key={key}
          size="compact-sm"
          variant="default"
          radius="xl"
          disabled={live.sending}
          onClick={() => live.send({ type: "note", text: t("pause.note", { reason: t(key) }) })}
        >
          {t(key)}
        </Button>
      ))}
    </div>
  );
}
