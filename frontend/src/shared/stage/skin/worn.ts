import type { BodyModel } from "./bodyModel";
import type { PoseSource } from "./pose";

/** The body that a figure wears, and what moves it. */
export interface Worn {
  readonly model: BodyModel;
  /** Stature of the wearer, metres: the body is scaled to it. */
  readonly statureM: number;
  readonly pose: PoseSource;
}
