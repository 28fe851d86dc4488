/**
 * What the page lets a script see of itself: `globalThis.reembody`, for self-tests and benchmarks.
 *
 * It shows and switches what is drawn, and changes nothing about the session or its record.
 */
import type { TimedRun } from "../tasks";
import type { HeadsetState, Status } from "../telemetry";
import type { Place } from "./ports";

/** What the device granted, and how it draws: part of what the participant saw. */
export interface Granted {
  readonly features: readonly string[];
  /** Hz as the device says; null if it does not. What is drawn is measured from the frames. */
  readonly frameRateHz: number | null;
  /** Fixed foveation as set, 0 (none) to 1 (the most); null where it cannot be set. */
  readonly foveation: number | null;
}

export interface Inspection {
  readonly state: HeadsetState;
  readonly status: Status;
  readonly place: Place;
  readonly run: TimedRun | null;
  readonly granted: Granted | null;
  /** Frames drawn since the page was loaded. */
  readonly frames: number;
  /** Whether the bodies of every frame drawn so far are computed. */
  readonly isIdle: boolean;
  /** Whether frames are rendered; everything else goes on without. */
  isRendering: boolean;
  /** Of the last rendered frame, both eyes together. */
  readonly drawn: { readonly calls: number; readonly triangles: number };
}

declare global {
  var reembody: Inspection | undefined;
}
