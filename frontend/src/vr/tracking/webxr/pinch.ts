/**
 * Whether a tracked hand pinches or makes a fist, from the places of its joints.
 *
 * Detected by ourselves, because some browsers send no select events for tracked hands (Safari on
 * Vision Pro). A gesture begins when the fingers are close, ends when they are clearly apart, and
 * then keeps for 150 ms: tracked tips tremble by millimetres, and a flicker must not answer twice.
 */
import { length, minus, type Vector } from "@shared/rotations";

/** Distance of the tips of thumb and index finger at which a pinch begins and ends, m. */
const PINCH_M = { begins: 0.02, ends: 0.034 } as const;
/** Tip to wrist over knuckle to wrist, of middle, ring and little finger: 1 is a closed fist. */
const FIST = { begins: 1.05, ends: 1.3 } as const;
const DEBOUNCE_S = 0.15;

/** A number that begins something when it is low, and ends it when it is clearly higher. */
export class Hysteresis {
  private isOn = false;
  private changedS = Number.NEGATIVE_INFINITY;

  constructor(
    private readonly begins: number,
    private readonly ends: number,
    private readonly debounceS = DEBOUNCE_S,
  ) {}

  /** The state at a time, for a value that may be NaN where it is unknown: then nothing changes. */
  at(timeS: number, value: number): boolean {
    const next = this.isOn ? !(value > this.ends) : value < this.begins;
    if (next !== this.isOn && timeS - this.changedS >= this.debounceS) {
      this.isOn = next;
      this.changedS = timeS;
    }
    return this.isOn;
  }

  /** The hand was lost: nothing is held on to. */
  release(): void {
    this.isOn = false;
  }
}

export const pinchDetector = (): Hysteresis => new Hysteresis(PINCH_M.begins, PINCH_M.ends);
export const fistDetector = (): Hysteresis => new Hysteresis(FIST.begins, FIST.ends);

/** The joints whose places the detectors need, by WebXR's names. */
export type JointPosition = (joint: XRHandJoint) => Vector | null;

export function pinchGapM(position: JointPosition): number {
  const [thumb, index] = [position("thumb-tip"), position("index-finger-tip")];
  return thumb === null || index === null ? Number.NaN : length(minus(thumb, index));
}

/** How open the three outer fingers are: the mean of tip to wrist over knuckle to wrist. */
export function openness(position: JointPosition): number {
  const wrist = position("wrist");
  if (wrist === null) return Number.NaN;
  let sum = 0;
  for (const finger of ["middle", "ring", "pinky"] as const) {
    const knuckle = position(`${finger}-finger-phalanx-proximal`);
    const tip = position(`${finger}-finger-tip`);
    if (knuckle === null || tip === null) return Number.NaN;
    sum += length(minus(tip, wrist)) / Math.max(length(minus(knuckle, wrist)), 1e-3);
  }
  return sum / 3;
}
