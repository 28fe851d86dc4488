/**
 * What a scripted person does about the surface that the task's rules expect next: the server's
 * `app/simulated_people/goals.py`.
 */
import type { Vector } from "@shared/rotations";
import type { ScriptedGoal } from "./movements";

const WAY_OUT_M = 0.12;
const STEP_CLEARANCE_M = 0.08;
const HALF_HAND_M = 0.05;

/** A block of the task, as in `vr/tasks/layout`. */
export interface GoalSurface {
  readonly kind: "panel" | "side" | "target" | "start";
  readonly box: number | null;
  readonly centerM: Vector;
  readonly halfSizeM: Vector;
}

export interface GoalContext {
  readonly limb: "hand" | "foot";
  /** Every surface of the layout, for the depth of boxes and the height of edges. */
  readonly surfaces: readonly GoalSurface[];
  readonly writingHand: "left" | "right";
  readonly leadingFoot: "left" | "right";
  /** The only foot that counts, if the study says so. */
  readonly countingFoot: "left" | "right" | null;
  /** How many boxes are green: feet alternate from box to box. */
  readonly greenCount: number;
  /** Whether the remote body cannot pass through the boxes, so that a hand must fit in. */
  readonly isSolid: boolean;
}

/** The goal for the surface to touch next; null if there is none, as when the phase is frozen. */
export function goalOn(surface: GoalSurface | null, context: GoalContext): ScriptedGoal | null {
  if (surface === null) return null;
  const [x, y, z] = surface.centerM;
  const [halfX, halfY, halfZ] = surface.halfSizeM;
  if (context.limb === "hand") {
    const room = Math.min(halfX, halfY) - (context.isSolid ? HALF_HAND_M : 0);
    return {
      kind: "reach",
      limb: context.writingHand,
      // The centre of the face towards the participant.
      targetM: [x, y, z + halfZ],
      nearM: Math.max(0.02, room),
      approachM: [0, 0, boxDepthM(surface, context) + WAY_OUT_M],
    };
  }
  const approachM: Vector = [0, edgeHeightM(context), 0];
  if (surface.kind === "start") {
    return { kind: "walk_to", limb: null, targetM: [x, 0, z], nearM: 0.1, approachM };
  }
  const { leadingFoot, countingFoot, greenCount } = context;
  const other = leadingFoot === "right" ? "left" : "right";
  return {
    kind: "step",
    limb: countingFoot ?? (greenCount % 2 === 0 ? leadingFoot : other),
    targetM: [x, y + halfY, z],
    nearM: Math.max(0.03, halfX * 0.6),
    approachM,
  };
}

/** How far the box's walls stand out in front of its panel. */
function boxDepthM({ box }: GoalSurface, { surfaces }: GoalContext): number {
  const sides = surfaces.filter((one) => one.kind === "side" && one.box === box);
  return Math.max(0, ...sides.map(({ halfSizeM }) => 2 * halfSizeM[2]));
}

/** A height that clears every edge of the boxes on the floor. */
function edgeHeightM({ surfaces }: GoalContext): number {
  const sides = surfaces.filter(({ kind }) => kind === "side");
  return Math.max(0, ...sides.map((one) => one.centerM[1] + one.halfSizeM[1])) + STEP_CLEARANCE_M;
}

const STEP_EVERY_S = 1.1;
const STEP_SIDE_M = 0.1;
const STEP_AHEAD_M = 0.1;
const STEP_HIGH_M = 0.22;

/** The step on the spot that is due: left and right foot in turn, to and fro, knees high. */
export function marchingStep(timeS: number): ScriptedGoal {
  const count = Math.floor(timeS / STEP_EVERY_S);
  const limb = count % 2 === 0 ? "left" : "right";
  const ahead = count % 4 < 2 ? -STEP_AHEAD_M : STEP_AHEAD_M;
  return {
    kind: "step",
    limb,
    targetM: [limb === "left" ? -STEP_SIDE_M : STEP_SIDE_M, 0, ahead],
    nearM: 0.03,
    approachM: [0, STEP_HIGH_M, 0],
  };
}
