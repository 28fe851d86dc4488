/** A shape for each kind of mark, told apart without colour. */
import type { MarkKind } from "./marks";

/** Width and height of a shape. */
export const MARK_PX = 12;

interface MarkShape {
  readonly path: string;
  readonly isFilled: boolean;
}

const SHAPES: Readonly<Record<MarkKind, MarkShape>> = {
  push: { path: "M2 1 L11 6 L2 11 Z", isFilled: true },
  pull: { path: "M3 2 L10.5 6 L3 10 Z", isFilled: false },
  drop: { path: "M2 2 H10 V10 H2 Z", isFilled: true },
  latency: { path: "M6 0.5 L11.5 6 L6 11.5 L0.5 6 Z", isFilled: true },
  gravity: { path: "M1 2 H11 L6 11 Z", isFilled: true },
  reset: { path: "M2 2 L10 10 M10 2 L2 10", isFilled: false },
  change: { path: "M6 1.5 A4.5 4.5 0 1 1 5.9 1.5 Z", isFilled: false },
};

export const markPath = (kind: MarkKind): MarkShape => SHAPES[kind];
