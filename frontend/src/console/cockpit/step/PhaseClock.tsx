/** The large clock of active time. It never shows more than the last report supports. */

import type { SessionRoad } from "@shared/api/road";
import type { Current, SessionView } from "@shared/api/types";
import { activeAt, type ClockReport, isHolding } from "@shared/clock";
import { clockFace } from "@shared/format";
import { isCrossing } from "@shared/session/steps";
import { Icon, type IconName } from "@shared/ui/Icon";
import { type Milliseconds, milliseconds, type Seconds, seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useMemo, useState } from "react";
import { type Key, useTexts } from "../../i18n";
import { sessionRoadQuery } from "../../queries";
import { causeKey, isOver } from "../../steps";
import { type TelemetryStore, useTelemetry } from "../session/telemetryStore";
import classes from "./CurrentStep.module.css";

const ICONS = {
  ready: "clock",
  preparing: "clock",
  running: "play",
  paused: "pause",
  walk_back: "walk",
  freezing: "stop",
} as const satisfies Record<string, IconName>;

interface PhaseClockProps {
  readonly session: SessionView;
  readonly store: TelemetryStore;
}

export function PhaseClock({ session, store }: PhaseClockProps): JSX.Element | null {
  const { t } = useTexts();
  const report = useReport(session, store);
  const now = useNow(report.running);
  const { current } = session;
  const step = session.steps[current?.index ?? -1];
  const isOnRoad = current?.status === "preparing" && step !== undefined && isCrossing(step);
  const { data: road } = useQuery({ ...sessionRoadQuery(session.id), enabled: isOnRoad });
  // A calibration and the traffic are shown as such; else only a scene that nobody sees holds it up.
  const isPending = current?.resuming === true && !SHOWN_ELSEWHERE.has(current.pause_reason ?? "");
  const isUnseen = useLasting(isPending, PENDING_MS);
  if (current === null) return null;
  const active = activeAt(report, now);
  const warning = warningOf(session, report, now, isUnseen);
  const cause = current.status === "paused" ? causeKey(current.pause_reason) : null;
  return (
    <>
      <div className={classes.clockRow} data-tour="clock">
        <div
          className={`${classes.clock} numbers ${report.running ? "" : classes.still}`}
          role="timer"
          aria-label={t("clock.label")}
        >
          {clockFace(active)}
        </div>
        <div className={classes.of}>
          {report.duration !== null && (
            <div className="numbers">{t("clock.of", { time: clockFace(report.duration) })}</div>
          )}
          <span className={`${classes.state} ${classes[current.status]}`}>
            <Icon name={ICONS[current.status]} size={18} />
            {t(isOnRoad ? beforeCrossing(session, road) : stateKey(current))}
            {cause !== null && `: ${t(cause)}`}
          </span>
        </div>
      </div>
      <Progress active={active} report={report} label={t("clock.progress")} />
      <div className={classes.stateNote} role="status">
        {warning !== null && (
          <>
            <Icon name="alert" size={16} />
            {t(warning)}
          </>
        )}
      </div>
    </>
  );
}

/**
 * The text of the clock's state; a pause or its end counts only once the headset has confirmed it.
 */
function stateKey(current: Current): Key {
  if (current.pausing) return "phase.pausing";
  if (!current.resuming) return `phase.${current.status}`;
  return current.pause_reason === "road" ? "road.resuming" : "phase.resuming";
}

/** What a phase on the road waits for before its clock starts. */
export function beforeCrossing(session: SessionView, road: SessionRoad | undefined): Key {
  if (road === undefined) return "phase.preparing";
  const phase = session.phases.findLast((one) => !isOver(one));
  // The scene is opened once the participant stands at the start; it has cars once it has warmed up.
  const { now } = road;
  if (now === null || now.phase_id !== phase?.phase_id) return "road.beforeStart";
  const hasCars = !now.is_over && now.waits_for.length === 0 && now.steps > 0;
  return hasCars ? "phase.preparing" : "road.beforeCars";
}

interface ProgressProps {
  readonly active: Seconds;
  readonly report: ClockReport;
  readonly label: string;
}

function Progress({ active, report, label }: ProgressProps): JSX.Element | null {
  if (report.duration === null) return null;
  const share = Math.min(1, active / report.duration);
  return (
    <div
      className={classes.progress}
      role="progressbar"
      aria-label={label}
      aria-valuemin={0}
      aria-valuemax={report.duration}
      aria-valuenow={Math.floor(active)}
    >
      <div
        className={`${classes.bar} ${report.running ? "" : classes.stopped}`}
        style={{ width: `${share * 100}%` }}
      />
    </div>
  );
}

const hasHeadset = (session: SessionView): boolean =>
  session.devices.some((device) => device.kind === "headset" && device.connected);

/** The newest report of the clock: the session's own, or telemetry that came after it. */
function useReport(session: SessionView, store: TelemetryStore): ClockReport {
  const received = useTelemetry(store);
  const { current, time_scale } = session;
  // The session's change and its time reach the page together, so the moment of receipt is taken
  // here.
  const own = useMemo(
    () => ({ active: current?.active_s ?? 0, at: milliseconds(performance.now()) }),
    [current],
  );
  const running = current?.status === "running" && hasHeadset(session);
  const fresh = running && received !== null && received.at > own.at;
  return {
    active: seconds(fresh ? received.telemetry.active_s : own.active),
    receivedAt: fresh ? received.at : own.at,
    duration: current?.duration_s == null ? null : seconds(current.duration_s),
    running,
    timeScale: time_scale,
  };
}

function warningOf(
  session: SessionView,
  report: ClockReport,
  now: Milliseconds,
  isUnseen: boolean,
): Key | null {
  if (!hasHeadset(session)) return "clock.noHeadset";
  if (isUnseen) return "clock.unseen";
  return isHolding(report, now) ? "clock.holding" : null;
}

const SHOWN_ELSEWHERE: ReadonlySet<string> = new Set(["calibration", "road"]);

/** A headset whose wearer sees the scene resumes within a few frames; after this it does not. */
const PENDING_MS = 2000;

/** Whether something has been so for some time. */
function useLasting(isSo: boolean, forMs: number): boolean {
  const [lasts, setLasts] = useState(false);
  useEffect(() => {
    setLasts(false);
    if (!isSo) return;
    const timer = setTimeout(() => setLasts(true), forMs);
    return () => clearTimeout(timer);
  }, [isSo, forMs]);
  return isSo && lasts;
}

const TICK_MS = 200;

/** The page's monotonic time, which ticks only while something depends on it. */
function useNow(ticking: boolean): Milliseconds {
  const [now, setNow] = useState(() => milliseconds(performance.now()));
  useEffect(() => {
    setNow(milliseconds(performance.now()));
    if (!ticking) return;
    const timer = setInterval(() => setNow(milliseconds(performance.now())), TICK_MS);
    return () => clearInterval(timer);
  }, [ticking]);
  return now;
}
