/**
 * The clock of a phase, between two reports of the server.
 *
 * The server owns the active time; this page only carries the last report forward so that the
 * display
 * does not jump. It never continues alone for long: without a new report it holds and says so.
 */
import { type Milliseconds, milliseconds, type Seconds, seconds } from "./units";

export interface ClockReport {
  /** Active time of the phase at the moment of the report. */
  readonly active: Seconds;
  /** Length of the phase, at which the clock ends; null for an open-ended phase. */
  readonly duration: Seconds | null;
  readonly running: boolean;
  /** Seconds of study time per second of real time; 1 except in simulated sessions. */
  readonly timeScale: number;
  /** When the report reached this page, on the page's own monotonic clock. */
  readonly receivedAt: Milliseconds;
}

/** After this time without a report the clock holds instead of guessing. */
export const HOLD_AFTER: Milliseconds = milliseconds(2500);

/** The active time now: the report carried forward by at most `HOLD_AFTER`, never past the end. */
export function activeAt(report: ClockReport, now: Milliseconds): Seconds {
  if (!report.running) return report.active;
  const waited = Math.min(Math.max(now - report.receivedAt, 0), HOLD_AFTER);
  const carried = report.active + (waited / 1000) * report.timeScale;
  return seconds(report.duration === null ? carried : Math.min(carried, report.duration));
}

/** Whether a running clock holds because no report has arrived for too long. */
export function isHolding(report: ClockReport, now: Milliseconds): boolean {
  return report.running && now - report.receivedAt > HOLD_AFTER;
}
