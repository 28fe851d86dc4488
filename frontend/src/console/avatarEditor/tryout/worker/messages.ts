/** What the page and the worker that simulates say to each other. */
import type { Command } from "../physics/commands";
import type { Shape } from "../physics/shapes";
import type { BodyToTry } from "../physics/triedBody";
import type { Progress } from "../physics/tryout";

export type ToWorker =
  | { readonly kind: "open"; readonly wasm: ArrayBuffer; readonly bodies: readonly BodyToTry[] }
  /** Other bodies; those that are the same go on. */
  | { readonly kind: "change"; readonly bodies: readonly BodyToTry[] }
  | { readonly kind: "command"; readonly command: Command }
  | {
      readonly kind: "advance";
      readonly ticks: number;
      readonly axis: string;
      /** The part that is chosen for a push. */
      readonly part?: string;
    };

export type FromWorker =
  | {
      readonly kind: "opened";
      readonly shapes: readonly (readonly Shape[])[];
      readonly longestLatencyS: number;
    }
  | { readonly kind: "advanced"; readonly advance: Advance }
  /** A command that could not be obeyed; the simulation goes on. */
  | { readonly kind: "refused"; readonly problem: string }
  | { readonly kind: "failed"; readonly problem: string };

export interface Advance {
  readonly ticks: number;
  /** The axis of its readings. */
  readonly axis: string;
  /** The simulation's time after it, seconds since the last reset. */
  readonly timeS: number;
  /** What computing it took. */
  readonly tookMs: number;
  readonly bodies: readonly Progress[];
}

/** The worker as the page sees it, or a port of the same kind in a test. */
export interface TryoutPort {
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
  postMessage(message: ToWorker, transfer?: Transferable[]): void;
  terminate(): void;
}
