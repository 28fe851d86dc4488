/** A person of thick round strokes: limbs as lines between joints, 200 units tall when upright. */
import type { JSX } from "react";

export type Point = readonly [x: number, y: number];

export interface Posture {
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
