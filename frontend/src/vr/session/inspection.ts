/**
 * What the page lets a script see of itself: `globalThis.reembody`, for self-tests and benchmarks.
 *
 * It shows and switches what is drawn, and changes nothing about the session or its record.
 */
import type { Vector } from "@shared/rotations";
import type { BodiesFrame } from "../bodies/bodies";
import type { CalibrationPrompt } from "../calibration";
import type { PanelScreen } from "../panels";
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
  /** The number of this run of the page, under which its frames and reports are stored. */
  readonly epoch: number;
  readonly state: HeadsetState;
  readonly status: Status;
  readonly place: Place;
  readonly run: TimedRun | null;
  /** The calibration that is under way; null otherwise. */
  readonly calibration: CalibrationPrompt | null;
  readonly granted: Granted | null;
  /** The bodies that were shown last; null before they have moved. */
  readonly computed: BodiesFrame | null;
  /** Gaps between frames that the simulation left out. */
  readonly skippedGaps: number;
  /** The parts of the avatar whose touches the rules are given, in their order. */
  readonly touchingParts: readonly string[];
  /** Frames drawn since the page was loaded. */
  readonly frames: number;
  /** Frames recorded in this run: what the server has of both bodies once all is sent. */
  readonly recorded: number;
  /** Whether the bodies of every frame drawn so far are computed. */
  readonly isIdle: boolean;
  /** Resolves when they are. */
  idle(): Promise<void>;
  /** Whether frames are rendered; everything else goes on without. */
  isRendering: boolean;
  /** What the participant reads, and where what can be pressed is in the room. */
  readonly panel: {
    readonly wanted: { readonly kind: string };
    readonly screen: PanelScreen | null;
    readonly targetsM: readonly { readonly target: string; readonly atM: Vector }[];
  };
  /** Of the last rendered frame, both eyes together. */
  readonly drawn: { readonly calls: number; readonly triangles: number };
}

declare global {
  var reembody: Inspection | undefined;
}
