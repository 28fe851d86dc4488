/** A wearer for tests of panels: where the eyes are, what the hands point at and do. */
import type { Vector } from "@shared/rotations";
import type { GoalPart, HandInput, TrackedFrame, TrackedPart } from "../../tracking/tracked";

const LOST: TrackedPart = { place: null, state: "lost", device: null };

export const EMPTY_HAND: HandInput = {
  fingers: null,
  ray: null,
  isSelecting: false,
  isSqueezing: false,
  holdsController: true,
};

const at = (positionM: Vector): TrackedPart => ({
  place: { positionM, rotation: [1, 0, 0, 0] },
  state: "tracked",
  device: "headset",
});

export interface Wearing {
  readonly timeS: number;
  readonly eyesM?: Vector | null;
  readonly left?: Partial<HandInput>;
  readonly right?: Partial<HandInput>;
  readonly parts?: Partial<Record<GoalPart, Vector>>;
}

/** A frame of somebody who looks along -z. */
export function frameOf({
  timeS,
  eyesM = [0, 1.6, 0],
  left,
  right,
  parts = {},
}: Wearing): TrackedFrame {
  const tracked: Record<GoalPart, TrackedPart> = {
    Hips: LOST,
    Head: LOST,
    LeftHand: at([-0.3, 0.9, 0]),
    RightHand: at([0.3, 0.9, 0]),
    LeftLowerLeg: LOST,
    RightLowerLeg: LOST,
  };
  for (const [part, positionM] of Object.entries(parts)) tracked[part as GoalPart] = at(positionM);
  return {
    timeS,
    eyes: eyesM === null ? null : { positionM: eyesM, rotation: [1, 0, 0, 0] },
    parts: tracked,
    hands: { left: { ...EMPTY_HAND, ...left }, right: { ...EMPTY_HAND, ...right } },
  };
}

/** The ray from a hand to a point. */
export function rayTo(originM: Vector, pointM: Vector): NonNullable<HandInput["ray"]> {
  const [x, y, z] = [pointM[0] - originM[0], pointM[1] - originM[1], pointM[2] - originM[2]];
  const norm = Math.hypot(x, y, z);
  return { originM, direction: [x / norm, y / norm, z / norm] };
}

/** Widths of a wide sans serif: what fits with it fits with the fonts of headsets. */
export const wideMeasure = (text: string, sizeDmm: number, isBold: boolean): number =>
  [...text].reduce((sum, sign) => sum + widthOf(sign), 0) * sizeDmm * (isBold ? 1.06 : 1);

const widthOf = (sign: string): number =>
  /[iljtf.,;:'!|()[\] ]/.test(sign)
    ? 0.33
    : /[mwMW@%]/.test(sign)
      ? 0.92
      : /[A-ZÄÖÜ]/.test(sign)
        ? 0.7
        : 0.58;
