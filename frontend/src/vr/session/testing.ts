/** Stand-ins for what surrounds the headset's loop, for its unit tests. */
import type { Bodies, BodiesFrame, BodiesInput } from "../bodies/bodies";
import { ORDER as PREPARING } from "../tasks/testing/orders";
import {
  type Frames,
  type HeadsetState,
  type PanelOrder,
  type PhaseOrder,
  type ReportBody,
  type Status,
  type StreamName,
  type TelemetryClient,
  VALUES_PER_FRAME,
  type Welcome,
} from "../telemetry";
import type { KnownBody, TrackedFrame, TrackingSource } from "../tracking/tracked";
import type { Keep } from "./calibrating";

/** A panel of the standby world: nothing is asked, and nobody is called. */
export const PANEL: PanelOrder = {
  language: "en",
  title: null,
  text: null,
  form: null,
  answer: null,
  acknowledge: false,
  headset_off: false,
  held: false,
  called: false,
};

export const ORDER: PhaseOrder = { ...PREPARING, duration_s: 2, freeze_s: 0.5 };

export const STATE: HeadsetState = {
  type: "state",
  version: 1,
  status: "active",
  step_index: 0,
  step_kind: "free_roam",
  materialised: true,
  recording: true,
  phase: null,
  participant: { handedness: "right", footedness: "right", stature_m: 1.75 },
};

/** What was sent, in order: frames with their stream, and reports. */
export type Sent =
  | { readonly what: "frames"; readonly stream: StreamName; readonly frames: Frames }
  | { readonly what: "report"; readonly body: ReportBody };

/** A client that stores what it is given, and whose state a test sets. */
export class FakeTelemetry {
  readonly sent: Sent[] = [];
  state: HeadsetState = STATE;
  settled = true;
  status = { connected: true } as Status;
  readonly welcome = {
    on_disconnect: "pause",
    bodies: [],
    tasks: {},
    state: STATE,
  } as unknown as Welcome;

  async sendFrames(stream: StreamName, frames: Frames): Promise<void> {
    this.sent.push({ what: "frames", stream, frames });
  }

  async report(body: ReportBody): Promise<void> {
    this.sent.push({ what: "report", body });
  }

  get client(): TelemetryClient {
    return this as unknown as TelemetryClient;
  }

  /** The times of all frames of a stream, in order. */
  times(stream: StreamName): readonly number[] {
    return this.sent.flatMap((one) =>
      one.what === "frames" && one.stream === stream ? [...one.frames.timesS] : [],
    );
  }

  /** The first value (x of the hips) of all frames of a stream. */
  xs(stream: StreamName): readonly number[] {
    return this.sent.flatMap((one) =>
      one.what === "frames" && one.stream === stream
        ? [...one.frames.timesS].map((_, i) => one.frames.values[i * VALUES_PER_FRAME] as number)
        : [],
    );
  }

  get reports(): readonly ReportBody[] {
    return this.sent.flatMap((one) => (one.what === "report" ? [one.body] : []));
  }
}

/** A place that keeps texts, as `localStorage` does. */
export class Kept implements Keep {
  readonly #texts = new Map<string, string>();

  getItem(key: string): string | null {
    return this.#texts.get(key) ?? null;
  }

  setItem(key: string, text: string): void {
    this.#texts.set(key, text);
  }

  removeItem(key: string): void {
    this.#texts.delete(key);
  }
}

/** Bodies whose hips are at x = the time of the input, shown `lateBy` steps later. */
export class FakeBodies implements Bodies {
  readonly touchingParts = ["Hips"];
  readonly skippedGaps = 0;
  latencyS = 0;
  worn: string | null = null;
  readonly #made: BodiesFrame[] = [];

  constructor(readonly lateBy = 0) {}

  get addedS(): number {
    return this.lateBy / 90;
  }

  wear(body: string | null): void {
    this.worn = body;
  }

  setLatency(orderedS: number): void {
    this.latencyS = orderedS;
  }

  showSurfaces(): void {}

  async change(): Promise<Readonly<Record<string, number>>> {
    return { LeftLowerArmY: 0.5 };
  }

  step({ timeS }: BodiesInput): void {
    this.#made.push(computedAt(timeS));
  }

  latest(): BodiesFrame | null {
    return this.#made[this.#made.length - 1 - this.lateBy] ?? null;
  }

  dispose(): void {}
}

/** A computed frame in which both bodies stand at x = `timeS`. */
export function computedAt(timeS: number): BodiesFrame {
  const pose = new Float64Array(VALUES_PER_FRAME);
  for (let i = 3; i < VALUES_PER_FRAME; i += 4) pose[i] = 1;
  pose[0] = timeS;
  return {
    timeS,
    local: pose,
    remote: pose,
    localFingers: null,
    remoteFingers: null,
    goalErrorsM: new Float64Array(6),
    touched: new Uint8Array(0),
    near: new Uint8Array(0),
    tookMs: 0,
    ikMs: 0,
    health: { restored: 0, resets: 0, ignoredInputs: 0, limitedTargets: 0, teleports: 0 },
  };
}

const HAND = {
  fingers: null,
  ray: null,
  isSelecting: false,
  isSqueezing: false,
  holdsController: true,
};
const PART = {
  place: { positionM: [0, 1, 0], rotation: [1, 0, 0, 0] },
  state: "tracked",
  device: "controller",
} as const;

/** A source whose head moves all the time unless a test holds it still, and whose grips a test presses. */
export class FakeSource implements TrackingSource {
  readonly kind = "controllers";
  readonly measures = new Set(["Head", "LeftHand", "RightHand"] as const);
  areGripsPressed = false;
  /** x of a head that does not move. */
  headStillAtM: number | null = null;

  constructor(readonly knownBody: KnownBody | null = null) {}

  read(timeS: number): TrackedFrame {
    const hand = { ...HAND, isSqueezing: this.areGripsPressed };
    return {
      timeS,
      eyes: { positionM: [this.headStillAtM ?? timeS, 1.6, 0], rotation: [1, 0, 0, 0] },
      parts: {
        Hips: { place: null, state: "lost", device: null },
        Head: PART,
        LeftHand: PART,
        RightHand: PART,
        LeftLowerLeg: { place: null, state: "lost", device: null },
        RightLowerLeg: { place: null, state: "lost", device: null },
      },
      hands: { left: hand, right: hand },
    };
  }

  dispose(): void {}
}
