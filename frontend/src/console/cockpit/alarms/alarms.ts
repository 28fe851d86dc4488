/** The active alarms in order of importance, and their texts. */
import type { Alarm, FailingNews, LiveAlarm, SessionView, StorageNews } from "@shared/api/types";
import { clockFace, number } from "@shared/format";
import { ALARMS, ALARMS_OF_PERSON, ALARMS_THAT_PAUSE } from "@shared/session/registries.generated";
import { type Milliseconds, milliseconds, type Seconds, seconds } from "@shared/units";
import { useEffect, useState } from "react";
import type { Key } from "../../i18n";
import { type Quality, type TelemetryStore, useQuality } from "../session/telemetryStore";

/** An alarm as it is shown, whether it was received live or read with the session. */
export interface ShownAlarm {
  /** The same for the same alarm, whichever source reported it. */
  readonly key: string;
  readonly code: string;
  readonly severity: Alarm["severity"];
  readonly since: string;
  readonly stream: string | null;
  readonly joints: readonly string[];
  /** Null if it would be outdated: only live messages keep it current. */
  readonly value: number | null;
  readonly unit: string | null;
}

/**
 * Messages about the headset come once a second; when they stop, the session's own alarms count.
 */
const MESSAGES_VALID: Milliseconds = 3000 as Milliseconds;

/** The active alarms: critical first, then the newest. */
export function currentAlarms(
  session: SessionView,
  quality: Quality | null,
  storage: Storage | null,
  now: Milliseconds,
  failing: readonly FailingNews[] = [],
): readonly ShownAlarm[] {
  const fresh = quality !== null && now - quality.at < MESSAGES_VALID;
  const recorded = session.alarms.filter((alarm) => !fresh || isAboutParticipant(alarm.code));
  const alarms = [...(fresh ? quality.alarms.map(fromMessage) : []), ...recorded.map(fromRecord)];
  return [...alarms, ...storageAlarms(storage), ...failing.map(failingAlarm)].toSorted(
    (a, b) => urgency(b) - urgency(a) || Date.parse(b.since) - Date.parse(a.since),
  );
}

/**
 * Alarms about the participant rather than the headset: the headset's messages never contain them.
 */
const isAboutParticipant = (code: string): boolean => ALARMS_OF_PERSON.some((one) => one === code);

const SEVERITIES = ["info", "warning", "critical"] as const;
const urgency = (alarm: ShownAlarm): number => SEVERITIES.indexOf(alarm.severity);

const keyOf = (alarm: Alarm | LiveAlarm): string =>
  `${alarm.code} ${alarm.stream ?? ""} ${Date.parse(alarm.since)}`;

const fromMessage = (alarm: LiveAlarm): ShownAlarm => ({ ...alarm, key: keyOf(alarm) });

/**
 * An alarm from the record, which has the value at its start; except for a gap's, a duration has
 * grown since.
 */
export function fromRecord(alarm: Alarm): ShownAlarm {
  const grows = alarm.unit === "s" && alarm.code !== "gap";
  return { ...alarm, key: keyOf(alarm), joints: [], value: grows ? null : alarm.value };
}

/** An alarm that came and went with one cause: shown once, with how often and how long. */
export interface AlarmGroup {
  /** The newest of them. */
  readonly newest: Alarm;
  readonly count: number;
  /** When the first of them began. */
  readonly since: string;
  /** How long they lasted together, without one that still lasts. */
  readonly lasted: Seconds;
}

/** The same alarms of the same stream as one, in the order of the newest of each. */
export function groupsOf(alarms: readonly Alarm[]): readonly AlarmGroup[] {
  const groups = new Map<string, Alarm[]>();
  for (const alarm of alarms) {
    const key = `${alarm.code} ${alarm.stream ?? ""}`;
    groups.set(key, [...(groups.get(key) ?? []), alarm]);
  }
  return [...groups.values()]
    .map((alike) => {
      const ordered = alike.toSorted((a, b) => Date.parse(b.since) - Date.parse(a.since));
      const [newest, ...earlier] = ordered as [Alarm, ...Alarm[]];
      const lastedMs = ordered.reduce(
        (sum, { since, cleared_at }) =>
          cleared_at === null ? sum : sum + Date.parse(cleared_at) - Date.parse(since),
        0,
      );
      const since = earlier.at(-1)?.since ?? newest.since;
      return { newest, count: ordered.length, since, lasted: seconds(lastedMs / 1000) };
    })
    .toSorted((a, b) => Date.parse(b.newest.since) - Date.parse(a.newest.since));
}

/**
 * The alarm to show: the newest of the most severe ones that is not acknowledged. An acknowledged
 * alarm still precedes any less severe one.
 */
export function mostUrgent(
  alarms: readonly ShownAlarm[],
  isSeen: (alarm: ShownAlarm) => boolean,
): ShownAlarm | undefined {
  const [first] = alarms;
  const alike = alarms.filter((alarm) => alarm.severity === first?.severity);
  return alike.find((alarm) => !isSeen(alarm)) ?? first;
}

/**
 * A key that changes whenever an alarm starts or ends, because the list of alarms has changed then.
 */
export const stateOf = (session: SessionView): string =>
  session.alarms.map((alarm) => alarm.id).join(" ");

type Code = (typeof ALARMS)[number];

const knownCode = (code: string): Code | "other" => ALARMS.find((one) => one === code) ?? "other";

export const titleKey = (alarm: ShownAlarm): Key => `alarm.${knownCode(alarm.code)}`;

/** Whether the participant waits for somebody to come. */
export const isCall = (alarm: ShownAlarm | undefined): boolean =>
  CALLS.some((code) => code === alarm?.code);

/** Alarms with which the participant calls the experimenter. */
export const CALLS = ["stop_asked", "help_asked", "question_asked"] as const;

/** The text of the remedy; while the phase is paused because of the alarm, that it is paused. */
export function remedyKey(alarm: ShownAlarm, session: SessionView): Key {
  const code = knownCode(alarm.code);
  const isPaused = session.current?.status === "paused";
  const paused = ALARMS_THAT_PAUSE.find((one) => one === code);
  if (isPaused && paused !== undefined) return `alarm.${paused}.paused`;
  return `alarm.${code}.do`;
}

/** `4 s`, `1:05`, `± 12 ms`, `61 Hz`, `3`: the value with its unit, if it is useful. */
export function amount(alarm: ShownAlarm, language: string): string | null {
  const { value, unit, code } = alarm;
  if (value === null || code === "jump") return null;
  if (code === "gap") return `${number(value, language, 2)} s`;
  // Where two are needed, 1.8 is not "2".
  if (code === "too_slow") return `${number(value, language, 1)} Hz`;
  if (unit === "s") return value < 60 ? `${Math.floor(value)} s` : clockFace(seconds(value));
  if (code === "clock_uncertain") return `± ${number(value, language, 0)} ms`;
  return unit === null ? number(value, language, 0) : `${number(value, language, 0)} ${unit}`;
}

/** `Left Hand, Head`: the joints concerned, at most three. */
export function jointNames(alarm: ShownAlarm): string | null {
  if (alarm.joints.length === 0) return null;
  const named = alarm.joints.slice(0, 3).map((joint) => joint.replace(/([a-z])([A-Z])/g, "$1 $2"));
  return named.join(", ") + (alarm.joints.length > 3 ? " …" : "");
}

export interface Storage {
  readonly news: StorageNews;
  /** When this page received it, as an ISO time. */
  readonly receivedAt: string;
}

/**
 * Problems with the server's disk, as alarms: they concern every session, and cannot be recorded.
 */
function storageAlarms(storage: Storage | null): readonly ShownAlarm[] {
  if (storage === null) return [];
  const { news, receivedAt: heardAt } = storage;
  if (news.status === "failing") return [alarm("storage", "critical", news.since ?? heardAt)];
  return news.low_disk ? [alarm("low_disk", "warning", heardAt)] : [];
}

/** The alarm of a failing background task of the server. */
const failingAlarm = (failing: FailingNews): ShownAlarm => {
  const code = failing.urgency === "critical" ? "writer_failed" : "background_failed";
  return alarm(code, failing.urgency, failing.since);
};

const alarm = (code: string, severity: ShownAlarm["severity"], since: string): ShownAlarm => ({
  key: `${code} ${since}`,
  code,
  severity,
  since,
  stream: null,
  joints: [],
  value: null,
  unit: null,
});

export interface Alarms {
  readonly on: readonly ShownAlarm[];
  readonly quality: Quality | null;
  readonly isAcknowledged: (alarm: ShownAlarm) => boolean;
  readonly see: (alarm: ShownAlarm) => void;
}

/** The active alarms, and which of them the operator has acknowledged. */
export function useAlarms(
  session: SessionView,
  store: TelemetryStore,
  storage: Storage | null,
  failing: readonly FailingNews[],
): Alarms {
  const quality = useQuality(store);
  const [acknowledged, setAcknowledged] = useState<ReadonlySet<string>>(new Set());
  useRerenderWhenOutdated(quality);
  return {
    on: currentAlarms(session, quality, storage, milliseconds(performance.now()), failing),
    quality,
    isAcknowledged: (alarm) => acknowledged.has(alarm.key),
    see: (alarm) => setAcknowledged((before) => new Set([...before, alarm.key])),
  };
}

/** Re-render when the messages have become outdated, since nothing else would. */
function useRerenderWhenOutdated(quality: Quality | null): void {
  const [, rerender] = useState<Quality | null>(null);
  useEffect(() => {
    const timer = setTimeout(() => rerender(quality), MESSAGES_VALID + 50);
    return () => clearTimeout(timer);
  }, [quality]);
}
