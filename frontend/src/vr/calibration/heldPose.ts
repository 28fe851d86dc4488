/** The mean of every device's place while a pose is held. */
import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import {
  length,
  minus,
  normalised,
  plus,
  type Quaternion,
  times,
  type Vector,
} from "@shared/rotations";
import type { GoalPart, TrackedFrame, TrackingDevice } from "../tracking/tracked";

/** Where a device was, and which one it was. */
export interface HeldPart {
  readonly place: Place;
  readonly device: TrackingDevice;
}

/** The means of a held pose; a part that was hardly seen, or not tracked, is absent. */
export interface HeldPose {
  readonly eyes: Place;
  readonly parts: ReadonlyMap<GoalPart, HeldPart>;
}

const STILL_M = 0.05;
const SEEN_SHARE = 0.5;

interface Sum {
  readonly device: TrackingDevice;
  readonly firstM: Vector;
  positionM: Vector;
  rotation: Quaternion;
  count: number;
}

/** Collects a pose until it has been held long enough; any large movement begins it anew. */
export class PoseMean {
  readonly #sums = new Map<GoalPart, Sum>();
  #sinceS: number | null = null;
  #frames = 0;

  /** `stillM`: how far a device may move; the default allows sway, but no step. */
  constructor(
    private readonly holdS: number,
    private readonly stillM = STILL_M,
  ) {}

  /** How long the pose has been held, as a share of what is needed. */
  progress(timeS: number): number {
    return this.#sinceS === null ? 0 : Math.min(1, (timeS - this.#sinceS) / this.holdS);
  }

  restart(): void {
    this.#sums.clear();
    this.#sinceS = null;
    this.#frames = 0;
  }

  /** Add a frame; false if somebody moved or took another device, so that the pose begins anew. */
  add({ timeS, eyes, parts }: TrackedFrame): boolean {
    this.#sinceS ??= timeS;
    this.#frames++;
    let isStill = this.#add("Head", eyes, "headset");
    for (const part of GOAL_PARTS) {
      const { place, device } = parts[part];
      if (part === "Head" || device === null) continue;
      isStill = this.#add(part, place, device) && isStill;
    }
    if (!isStill) this.restart();
    return isStill;
  }

  /** The means, once the pose has been held long enough; null before. */
  held(timeS: number): HeldPose | null {
    if (this.progress(timeS) < 1) return null;
    const parts = new Map<GoalPart, HeldPart>();
    let eyes: Place | null = null;
    for (const [part, sum] of this.#sums) {
      if (sum.count < SEEN_SHARE * this.#frames) continue;
      const place = {
        positionM: times(sum.positionM, 1 / sum.count),
        rotation: normalised(sum.rotation),
      };
      if (part === "Head") eyes = place;
      else parts.set(part, { place, device: sum.device });
    }
    return eyes === null ? null : { eyes, parts };
  }

  #add(part: GoalPart, place: Place | null, device: TrackingDevice): boolean {
    if (place === null) return true;
    const { positionM, rotation } = place;
    const sum = this.#sums.get(part);
    if (sum === undefined) {
      this.#sums.set(part, { device, firstM: positionM, positionM, rotation, count: 1 });
      return true;
    }
    sum.count++;
    sum.positionM = plus(sum.positionM, positionM);
    sum.rotation = added(sum.rotation, rotation);
    return sum.device === device && length(minus(positionM, sum.firstM)) <= this.stillM;
  }
}

/** A quaternion and its opposite are the same rotation: add the one nearer to the sum. */
function added(sum: Quaternion, one: Quaternion): Quaternion {
  const sign = sum[0] * one[0] + sum[1] * one[1] + sum[2] * one[2] + sum[3] * one[3] < 0 ? -1 : 1;
  return [
    sum[0] + sign * one[0],
    sum[1] + sign * one[1],
    sum[2] + sign * one[2],
    sum[3] + sign * one[3],
  ];
}
