/**
 * The newest telemetry of one session. It arrives several times a second, so it is kept outside of
 * React's state: only the parts that show it render again.
 */
import type { LiveAlarm, Signal, Telemetry, TelemetryNews } from "@shared/api/types";
import { type Milliseconds, milliseconds } from "@shared/units";
import { useSyncExternalStore } from "react";

export interface Received {
  readonly telemetry: Telemetry;
  readonly at: Milliseconds;
}

/** How good the data are; also received while no frames arrive. */
export interface Quality {
  readonly signal: Signal | null;
  readonly alarms: readonly LiveAlarm[];
  readonly at: Milliseconds;
}

export class TelemetryStore {
  #latest: Received | null = null;
  #quality: Quality | null = null;
  readonly #listeners = new Set<() => void>();

  readonly put = (news: TelemetryNews): void => {
    const at = milliseconds(performance.now());
    this.#quality = { signal: news.signal, alarms: news.alarms, at };
    if (hasFigures(news)) {
      this.#latest = { telemetry: withErrors(news, this.#latest?.telemetry), at };
    }
    for (const listener of this.#listeners) listener();
  };

  readonly latest = (): Received | null => this.#latest;

  readonly quality = (): Quality | null => this.#quality;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };
}

export const useTelemetry = (store: TelemetryStore): Received | null =>
  useSyncExternalStore(store.subscribe, store.latest);

export const useQuality = (store: TelemetryStore): Quality | null =>
  useSyncExternalStore(store.subscribe, store.quality);

/**
 * Whether a message has figures. Those without frames do not mention the clock: its last report
 * stays.
 */
const hasFigures = (news: TelemetryNews): news is TelemetryNews & Telemetry =>
  news.phase_id !== undefined;

/**
 * Keep the last joint errors of the same phase: they need both poses of one moment, and are missing
 * from messages with only one.
 */
function withErrors(news: Telemetry, before: Telemetry | undefined): Telemetry {
  const hasErrors = Object.keys(news.joint_error_deg ?? {}).length > 0;
  if (hasErrors || before?.joint_error_deg === undefined || before.phase_id !== news.phase_id) {
    return news;
  }
  return { ...news, joint_error_deg: before.joint_error_deg };
}
