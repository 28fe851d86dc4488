/**
 * A recording that moves the participant: a capture on the server's skeleton, or the movement of an
 * earlier session, played in a loop.
 *
 * The recording holds positions and local rotations of the 22 joints (`docs/protocol.md`, section
 * 6), at its own rate; between its frames it is interpolated. It starts anew where it ends, faded
 * over half a second.
 */
import type { Place } from "@shared/avatar/hips";
import { multiply, plus, type Quaternion, rotate, type Vector } from "@shared/rotations";
import { clear, type FrameBuffer, frameBuffer, inferHips, set } from "../frameBuffer";
import { blendedRotation, onFloor } from "../places";
import {
  INDEX,
  JOINTS,
  type Joint,
  jointPlaces,
  PARENTS,
  type Skeleton,
  skeletonOf,
} from "../skeleton";
import type { GoalPart, KnownBody, TrackedFrame, TrackingSource } from "../tracked";

/** A movement as the server gives it (`shared/stage/motion`). */
export interface Recording {
  readonly names: readonly string[];
  readonly frames: number;
  readonly rateHz: number;
  readonly positions: ArrayLike<number>;
  readonly rotations?: ArrayLike<number>;
}

/** Thrown for a recording that does not hold the 22 joints with rotations. */
export class RecordingError extends Error {
  override readonly name = "RecordingError";
}

const GOALS: readonly (readonly [GoalPart, Joint])[] = [
  ["Head", "Head"],
  ["LeftHand", "LeftHand"],
  ["RightHand", "RightHand"],
  ["LeftLowerLeg", "LeftLowerLeg"],
  ["RightLowerLeg", "RightLowerLeg"],
  ["Hips", "Hips"],
];
const FADE_S = 0.5;

export class CaptureSource implements TrackingSource {
  readonly kind = "capture";
  readonly measures: ReadonlySet<GoalPart> = new Set(GOALS.map(([part]) => part));
  readonly knownBody: KnownBody;
  private readonly skeleton: Skeleton;
  private readonly columns: readonly number[];
  private readonly rotations: ArrayLike<number>;
  private readonly originM: Vector;
  private readonly turn: Quaternion;
  private readonly scale: number;
  private readonly places = jointPlaces();
  private readonly frame: FrameBuffer = frameBuffer();
  private startS: number | null = null;

  /**
   * `statureM`: that of the participant; the recording's place and heading at its start become those
   * of the start square, its way over the floor is scaled with the height of the hips.
   *
   * Throws RecordingError if joints or rotations are missing.
   */
  constructor(
    private readonly recording: Recording,
    statureM: number,
  ) {
    const { names, frames, positions, rotations } = recording;
    const missing = JOINTS.filter((joint) => !names.includes(joint));
    if (missing.length > 0 || rotations === undefined) {
      const what = missing.length > 0 ? missing.join(", ") : "rotations";
      throw new RecordingError(
        `The recording lacks ${what}: choose a capture whose joints are mapped to the body.`,
      );
    }
    if (frames < 2) throw new RecordingError("The recording has fewer than two frames.");
    this.skeleton = skeletonOf(statureM);
    this.knownBody = { statureM, spanM: this.skeleton.spanM };
    this.columns = JOINTS.map((joint) => names.indexOf(joint));
    this.rotations = rotations;
    const hips = this.columns[INDEX.Hips] as number;
    const heightM = positions[3 * hips + 1] as number;
    this.scale = heightM > 0.1 ? this.skeleton.standingHipsM / heightM : 1;
    const right = rotate(this.rotationIn(0, INDEX.Hips), [1, 0, 0]);
    const { rotation } = onFloor(0, 0, Math.atan2(right[2], right[0]));
    this.turn = rotation;
    this.originM = [positions[3 * hips] as number, 0, positions[3 * hips + 2] as number];
  }

  /** How long it lasts. */
  get durationS(): number {
    return (this.recording.frames - 1) / this.recording.rateHz;
  }

  read(timeS: number): TrackedFrame {
    this.startS ??= timeS;
    const { durationS, frame } = this;
    const atS = (timeS - this.startS) % durationS;
    clear(frame, timeS);
    const fade = Math.min(FADE_S, durationS / 2);
    // The end runs into the beginning, so that the body does not jump.
    const share = atS > durationS - fade ? (atS - durationS + fade) / fade : 0;
    this.place(atS, share);
    for (const [part, joint] of GOALS) {
      const positionM = this.places.positionsM[INDEX[joint]] as Vector;
      const rotation = this.places.rotations[INDEX[joint]] as Quaternion;
      set(frame.parts[part], { positionM, rotation }, "joint");
    }
    frame.eyes = this.eyes();
    inferHips(frame);
    return frame;
  }

  dispose(): void {}

  private place(atS: number, share: number): void {
    const { skeleton, places } = this;
    const rootM = mix(this.rootAt(atS), this.rootAt(0), share);
    for (const [joint, parent] of PARENTS.entries()) {
      const own = this.rotationAt(atS, joint);
      const local = share > 0 ? blendedRotation(own, this.rotationAt(0, joint), share) : own;
      if (parent < 0) {
        places.positionsM[joint] = rootM;
        places.rotations[joint] = multiply(this.turn, local);
        continue;
      }
      const above = places.rotations[parent] as Quaternion;
      const offset = rotate(above, skeleton.offsetsM[joint] as Vector);
      places.positionsM[joint] = plus(places.positionsM[parent] as Vector, offset);
      places.rotations[joint] = multiply(above, local);
    }
  }

  private eyes(): Place {
    const positionM = this.places.positionsM[INDEX.Head] as Vector;
    const rotation = this.places.rotations[INDEX.Head] as Quaternion;
    const offset = rotate(rotation, [0, 0.061 * this.skeleton.statureM, -0.09]);
    return { positionM: plus(positionM, offset), rotation };
  }

  private rootAt(atS: number): Vector {
    const [frame, share] = this.frameAt(atS);
    const read = (at: number): Vector => {
      const start = 3 * (at * this.recording.names.length + (this.columns[INDEX.Hips] as number));
      const [x, y, z] = [0, 1, 2].map(
        (axis) => this.recording.positions[start + axis] as number,
      ) as [number, number, number];
      return [x - this.originM[0], y, z - this.originM[2]];
    };
    const [x, y, z] = mix(read(frame), read(frame + 1), share);
    return rotate(this.turn, [this.scale * x, this.scale * y, this.scale * z]);
  }

  private rotationAt(atS: number, joint: number): Quaternion {
    const [frame, share] = this.frameAt(atS);
    return blendedRotation(this.rotationIn(frame, joint), this.rotationIn(frame + 1, joint), share);
  }

  private rotationIn(frame: number, joint: number): Quaternion {
    const at = 4 * (frame * this.recording.names.length + (this.columns[joint] as number));
    const values = [0, 1, 2, 3].map((axis) => this.rotations[at + axis] as number);
    const size = Math.hypot(...values);
    // A rotation of zeros is unknown: the joint rests.
    if (!(size > 0)) return [1, 0, 0, 0];
    return values.map((value) => value / size) as unknown as Quaternion;
  }

  private frameAt(atS: number): readonly [frame: number, share: number] {
    const at = atS * this.recording.rateHz;
    const frame = Math.min(Math.floor(at), this.recording.frames - 2);
    return [frame, at - frame];
  }
}

const mix = (a: Vector, b: Vector, share: number): Vector => [
  a[0] + share * (b[0] - a[0]),
  a[1] + share * (b[1] - a[1]),
  a[2] + share * (b[2] - a[2]),
];
