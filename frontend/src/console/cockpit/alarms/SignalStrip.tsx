/**
 * How good the headset's data are, always in the same place and at the same height: a problem fills
 * it with colour and shows the remedy, and nothing on the page moves.
 */
import { Button } from "@mantine/core";
import { sessions } from "@shared/api/endpoints";
import type { SessionView, Signal } from "@shared/api/types";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { alarmsQuery } from "../../queries";
import { awaitsHeadset } from "../session/action";
import {
  type Alarms,
  amount,
  groupsOf,
  isCall,
  jointNames,
  mostUrgent,
  remedyKey,
  type ShownAlarm,
  stateOf,
  titleKey,
} from "./alarms";
import classes from "./SignalStrip.module.css";

interface SignalStripProps {
  readonly session: SessionView;
  readonly alarms: Alarms;
  readonly onHistory: () => void;
}

export function SignalStrip({ session, alarms, onHistory }: SignalStripProps): JSX.Element {
  const { t } = useTexts();
  const first = mostUrgent(alarms.on, alarms.isAcknowledged);
  const isAwaited = first === undefined && awaitsHeadset(session);
  const tone =
    first !== undefined ? classes[first.severity] : classes[isAwaited ? "warning" : "fine"];
  const acknowledged = first !== undefined && alarms.isAcknowledged(first);
  const signal = alarms.quality?.signal ?? null;
  const total = groupsOf(useQuery(alarmsQuery(session.id, stateOf(session))).data ?? []).length;
  return (
    <section
      className={`${classes.strip} ${tone} ${acknowledged ? classes.acknowledged : ""}`}
      data-tour="signal"
      aria-label={t("signal.label")}
    >
      {first === undefined ? (
        <NoAlarm session={session} isRecording={isMoving(signal)} hadAlarms={total > 0} />
      ) : (
        <ActiveAlarm alarm={first} session={session} others={alarms.on.length - 1} />
      )}
      {isCall(first) && <AnswerCall session={session} />}
      {first !== undefined && !isCall(first) && !acknowledged && (
        <Button size="xs" variant="default" onClick={() => alarms.see(first)}>
          {t("alarm.understood")}
        </Button>
      )}
      {session.ended_at === null && <Figures signal={signal} />}
      <Button
        size="xs"
        variant="default"
        leftSection={<Icon name="list" size={16} />}
        onClick={onHistory}
      >
        {t("alarm.open")}
        {total > 0 && <span className={`${classes.total} numbers`}>{total}</span>}
      </Button>
    </section>
  );
}

/** The participant's call ends when somebody is there, not when somebody has read it. */
function AnswerCall({ session }: { readonly session: SessionView }): JSX.Element | null {
  const { t } = useTexts();
  const can = usePermissions();
  const answer = useMutation({ mutationFn: () => sessions.answerHelp(session.id) });
  if (!can("run")) return null;
  return (
    <Button size="xs" loading={answer.isPending} onClick={() => answer.mutate()}>
      {t("alarm.help_asked.answer")}
    </Button>
  );
}

const isMoving = (signal: Signal | null): boolean =>
  signal !== null && (signal.frame_rate_hz ?? 0) > 0;

interface NoAlarmProps {
  readonly session: SessionView;
  readonly isRecording: boolean;
  /** Whether its list of alarms has any. */
  readonly hadAlarms: boolean;
}

function NoAlarm({ session, isRecording, hadAlarms }: NoAlarmProps): JSX.Element {
  const { t } = useTexts();
  const ended = session.ended_at !== null;
  if (awaitsHeadset(session)) return <HeadsetAwaited />;
  const connected = session.devices.some((one) => one.kind === "headset" && one.connected);
  const body: Key = !connected
    ? "signal.fine.noHeadset"
    : isRecording
      ? "signal.fine.recording"
      : "signal.fine.waiting";
  return (
    <div className={classes.message}>
      <Icon name={connected && isRecording ? "check" : "info"} size={22} />
      <div className={classes.words} role="status">
        <div className={classes.title}>{t(ended ? "signal.over" : "signal.fine")}</div>
        <div className={classes.remedy}>{ended ? hadAlarms && t("signal.over.body") : t(body)}</div>
      </div>
    </div>
  );
}

/** Nothing is being recorded yet, so the server has no alarm; but nothing can go on either. */
function HeadsetAwaited(): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.message}>
      <Icon name="alert" size={26} />
      <div className={classes.words} role="status">
        <div className={classes.title}>{t("signal.awaited")}</div>
        <div className={classes.remedy}>{t("signal.awaited.do")}</div>
      </div>
    </div>
  );
}

interface ActiveAlarmProps {
  readonly alarm: ShownAlarm;
  readonly session: SessionView;
  readonly others: number;
}

function ActiveAlarm({ alarm, session, others }: ActiveAlarmProps): JSX.Element {
  const { t, language } = useTexts();
  const joints = jointNames(alarm);
  const amountText = amount(alarm, language);
  const remedy = t(remedyKey(alarm, session));
  return (
    <div className={classes.message}>
      <Icon name="alert" size={26} />
      <div className={classes.words}>
        <div className={classes.title}>
          <span role={alarm.severity === "critical" ? "alert" : "status"}>
            {t(titleKey(alarm))}
            {joints !== null && `: ${joints}`}
            <span className="visually-hidden">{`: ${remedy}`}</span>
          </span>
          {/* A value that grows every second is not announced every second by screen readers. */}
          {amountText !== null && (
            <span className={`${classes.amount} numbers`} aria-hidden="true">
              {isDuration(alarm) ? t("alarm.for", { time: amountText }) : amountText}
            </span>
          )}
          {others > 0 && (
            <span className={classes.otherAlarms}>{t("alarm.more", { count: others })}</span>
          )}
        </div>
        <div className={classes.remedy} aria-hidden="true" title={remedy}>
          {remedy}
        </div>
      </div>
    </div>
  );
}

const isDuration = ({ code, unit }: ShownAlarm): boolean =>
  unit === "s" && code !== "gap" && code !== "backlog";

function Figures({ signal }: { readonly signal: Signal | null }): JSX.Element {
  const { t, language } = useTexts();
  const show = (value: number | null | undefined, digits: number, unit = "", before = "") =>
    value === null || value === undefined
      ? "–"
      : `${before}${number(value, language, digits)}${unit}`;
  const usual = show(signal?.usual_rate_hz, 0, " Hz");
  const gaps = signal?.gaps ? ` · ${show(signal.gap_s, 1, " s")}` : "";
  const figures = [
    ["rate", show(signal?.frame_rate_hz, 0, " Hz")],
    ["gaps", `${show(signal?.gaps, 0)}${gaps}`],
    ["clock", show(signal?.clock_uncertainty_ms, 1, " ms", "± ")],
    ["behind", show(signal?.behind_s, 1, " s")],
    ["flagged", show(signal?.frames_flagged, 0)],
  ] as const;
  return (
    <dl className={`${classes.figures} numbers`}>
      {figures.map(([name, value]) => (
        <div
          key={name}
          className={classes[name]}
          title={t(`signal.hint.${name}`, name === "rate" ? { usual } : undefined)}
        >
          <dt>{t(`signal.${name}`)}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
