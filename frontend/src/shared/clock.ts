/**
 * The clock of a phase, between two reports of the server.
 *
 * The server owns active time; this page only carries the last report forward so that the display
 * does not jump. It never runs on by itself for long: without a fresh report it holds and says so.
 */
import { type Milliseconds, milliseconds, type Seconds, seconds } from "./units";

export interface ClockReport {
  /** Active time of the phase at the moment of the report. */
  readonly active: Seconds;
  /** Length of the phase, at which the clock ends; null when it is open-ended. */
  readonly duration: Seconds | null;
  readonly running: boolean;
  /** Seconds of the study per second of the wall; 1 except in simulated sessions. */
  readonly timeScale: number;
  /** When the report reached this page, on the page's own monotonic clock. */
  readonly receivedAt: Milliseconds;
}

/** After this long without a report the clock holds instead of guessing. */
export const HOLD_AFTER: Milliseconds = milliseconds(2500);

/** Active time now: the report carried forward by at most `HOLD_AFTER`, never past the end. */
export function activeAt(report: ClockReport, now: Milliseconds): Seconds {
  if (!report.running) return report.active;
  const waited = Math.min(Math.max(now - report.receivedAt, 0), HOLD_AFTER);
  const carried = report.active + (waited / 1000) * report.timeScale;
  return seconds(report.duration === null ? carried : Math.min(carried, report.duration));
}

/** True when a running clock has heard nothing for so long that it holds. */
export function isHolding(report: ClockReport, now: Milliseconds): boolean {
  return report.running && now - report.receivedAt > HOLD_AFTER;
}
