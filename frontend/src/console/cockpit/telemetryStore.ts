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

  readonly put = (telemetry: Telemetry): void => {
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
