/**
 * The newest telemetry of one session. It arrives several times a second, so it lives outside the
 * page's state: only the parts that show it draw again.
 */
import type { Telemetry } from "@shared/api/types";
import { type Milliseconds, milliseconds } from "@shared/units";
import { useSyncExternalStore } from "react";

export interface Received {
  readonly telemetry: Telemetry;
  readonly at: Milliseconds;
}

export class TelemetryStore {
  #latest: Received | null = null;
  readonly #listeners = new Set<() => void>();

  readonly put = (news: Telemetry): void => {
    const telemetry = withErrors(news, this.#latest?.telemetry);
    this.#latest = { telemetry, at: milliseconds(performance.now()) };
    for (const listener of this.#listeners) listener();
  };

  readonly latest = (): Received | null => this.#latest;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };
}

export const useTelemetry = (store: TelemetryStore): Received | null =>
  useSyncExternalStore(store.subscribe, store.latest);

/**
 * Joint errors need both poses of one moment and are missing from messages that hold only one; the
 * last ones of the same phase stay in sight meanwhile.
 */
function withErrors(news: Telemetry, before: Telemetry | undefined): Telemetry {
  const told = Object.keys(news.joint_error_deg ?? {}).length > 0;
  if (told || before?.joint_error_deg === undefined || before.phase_id !== news.phase_id) {
    return news;
  }
  return { ...news, joint_error_deg: before.joint_error_deg };
}
