/** Everything that is measured between the first and the last frame of a test. */
import type { BodiesFrame } from "../../bodies";
import type { TrackedFrame, TrackingSource } from "../../tracking";
import { deviceName, inputsOf, memoryBytes } from "../device";
import { MOST_ERRORS } from "../errors";
import { newReportId, type Report } from "../report";
import { PhysicsRecord } from "./physics";
import { FrameTimes } from "./rendering";
import { TrackingRecord } from "./tracking";

/** What a frame shows of the parts that are measured. */
export interface Measured {
  readonly timeS: number;
  /** What the devices report. */
  readonly worn: TrackedFrame;
  /** What moves the body, and what kind of source that is. */
  readonly moved: TrackedFrame;
  readonly kind: TrackingSource["kind"];
  readonly computed: BodiesFrame | null;
}

/** What the report says besides what was measured in frames. */
export interface Surroundings {
  readonly userAgent: string;
  /** What people call the device; null if its browser's own name for it counts. */
  readonly name: string | null;
  readonly mode: Report["rendering"]["mode"];
  readonly nominalHz: number | null;
  /** The body that was computed; null if there was none. */
  readonly model: { readonly model_hash: string; readonly stature_m: number } | null;
  readonly storage: Report["storage"];
  readonly errors: readonly string[];
}

/** Gaps between frames are left out by the simulation. */
const TOO_SLOW = "physics: every frame came too late to be simulated";

export class Measurement {
  readonly #id = newReportId();
  readonly #frames = new FrameTimes();
  readonly #tracking = new TrackingRecord();
  readonly #physics = new PhysicsRecord();
  readonly #inputs = new Set<Report["device"]["inputs"][number]>();

  /** `startS`: on the clock of the frames; `startedAt`: the same moment by the wall. */
  constructor(
    readonly startS: number,
    readonly startedAt: Date,
  ) {}

  /** From the first frame to the newest, s. */
  get durationS(): number {
    return this.#frames.durationS;
  }

  note({ timeS, worn, moved, kind, computed }: Measured): void {
    this.#frames.note(timeS);
    this.#tracking.note(worn);
    for (const input of inputsOf(moved, kind)) this.#inputs.add(input);
    if (computed !== null) this.#physics.note(computed);
  }

  report(around: Surroundings): Report {
    const { userAgent, name, mode, nominalHz, model, storage, errors } = around;
    const physics = model === null ? null : this.#physics.figures({ ...model, where: "worker" });
    const isUnsaid = model !== null && physics === null;
    const noted = isUnsaid ? [TOO_SLOW, ...errors].slice(0, MOST_ERRORS) : [...errors];
    return {
      id: this.#id,
      started_at: this.startedAt.toISOString(),
      duration_s: this.durationS,
      device: {
        user_agent: userAgent,
        name: name ?? deviceName(userAgent),
        inputs: [...this.#inputs],
      },
      rendering: this.#frames.figures(mode, nominalHz),
      physics,
      tracking: this.#tracking.figures(),
      storage,
      page: { memory_bytes: memoryBytes(), errors: noted },
    };
  }
}
