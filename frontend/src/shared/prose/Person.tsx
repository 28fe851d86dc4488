/**
 * A person drawn in thick round strokes: limbs as lines between joints, 200 units tall when
 * upright.
 */
import type { JSX } from "react";

type Point = readonly [x: number, y: number];

interface Posture {
  readonly head: Point;
  readonly trunk: readonly [Point, Point];
  readonly arms: readonly (readonly Point[])[];
  readonly legs: readonly (readonly Point[])[];
}

const line = (points: readonly Point[]): string =>
  points.map(([x, y], index) => `${index === 0 ? "M" : "L"}${x} ${y}`).join("");

export function Person({ posture }: { readonly posture: Posture }): JSX.Element {
  const { head, trunk, arms, legs } = posture;
  return (
    <g
      fill="none"
      stroke="currentColor"
      strokeWidth={11}
      strokeLinecap="round"
      strokeLinejoin="round"
    >
      <circle cx={head[0]} cy={head[1]} r={14} fill="currentColor" strokeWidth={0} />
      <path d={line(trunk)} strokeWidth={20} />
      {[...arms, ...legs].map((limb) => (
        <path key={line(limb)} d={line(limb)} />
      ))}
    </g>
  );
}

// Postures of the people in the pictures, with feet near y = 210.

/** Joints of a limb, with x measured from the body's middle to the right. */
type Limb = readonly Point[];

const shifted = (limb: Limb, x: number): Limb => limb.map(([across, y]) => [x + across, y]);
const mirrored = (limb: Limb): Limb => limb.map(([across, y]) => [-across, y]);

/** Seen from the front, so both sides mirror each other. */
const facing = (x: number, arm: Limb, leg: Limb): Posture => ({
  head: [x, 28],
  trunk: [
    [x, 64],
    [x, 118],
  ],
  arms: [shifted(mirrored(arm), x), shifted(arm, x)],
  legs: [shifted(mirrored(leg), x), shifted(leg, x)],
});

/** Seen from the side, facing right. */
const sideways = (x: number, arms: readonly Limb[], legs: readonly Limb[]): Posture => ({
  head: [x + 4, 28],
  trunk: [
    [x + 2, 64],
    [x, 118],
  ],
  arms: arms.map((limb) => shifted(limb, x)),
  legs: legs.map((limb) => shifted(limb, x)),
});

/** Upright, arms stretched out to the sides, feet together. */
export const tPose = (x: number): Posture =>
  facing(
    x,
    [
      [14, 60],
      [88, 60],
    ],
    [
      [5, 122],
      [6, 206],
    ],
  );

/** Upright, the arms a little off the body. */
export const standing = (x: number): Posture =>
  facing(
    x,
    [
      [14, 60],
      [30, 94],
      [32, 128],
    ],
    [
      [6, 122],
      [12, 206],
    ],
  );

/** One arm reaching forward at the height of the chest. */
export const reaching = (x: number): Posture =>
  sideways(
    x,
    [
      [
        [4, 62],
        [46, 78],
        [92, 74],
      ],
      [
        [0, 62],
        [-10, 96],
        [-4, 130],
      ],
    ],
    [
      [
        [0, 122],
        [-12, 206],
      ],
      [
        [0, 122],
        [16, 206],
      ],
    ],
  );

/** One foot lifted over an edge. */
export const stepping = (x: number): Posture =>
  sideways(
    x,
    [
      [
        [2, 62],
        [20, 94],
        [40, 112],
      ],
      [
        [0, 62],
        [-18, 94],
        [-30, 118],
      ],
    ],
    [
      [
        [0, 122],
        [-4, 206],
      ],
      [
        [0, 122],
        [44, 146],
        [52, 186],
      ],
    ],
  );
