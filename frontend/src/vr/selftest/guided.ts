/** A scripted person who does what the plan asks, where nobody wears the headset. */
import type { Vector } from "@shared/rotations";
import { marchingStep, type ScriptedGoal, ScriptedPerson, ScriptSource } from "../tracking/script";
import type { TrackedFrame } from "../tracking/tracked";
import type { Movement } from "./plan";

const SEED = 1;
const LOOK_EVERY_S = 2;
const LOOKS_M: readonly Vector[] = [
  [-2, 1.6, -2],
  [0, 2.4, -2],
  [2, 1.6, -2],
  [0, 0.6, -2],
];
const REACH_EVERY_S = 1.4;

export class GuidedPerson {
  readonly source: ScriptSource;
  readonly #person: ScriptedPerson;

  constructor(statureM: number) {
    this.#person = new ScriptedPerson({ statureM, seed: SEED });
    this.source = new ScriptSource(this.#person);
  }

  /** The person at a time, doing this movement; null stands at ease. */
  read(timeS: number, movement: Movement | null): TrackedFrame {
    const person = this.#person;
    const round = Math.floor(timeS / LOOK_EVERY_S);
    person.lookAt(movement === "look" ? (LOOKS_M[round % LOOKS_M.length] ?? null) : null);
    person.pursue(goalAt(timeS, movement));
    return this.source.read(timeS);
  }
}

function goalAt(timeS: number, movement: Movement | null): ScriptedGoal | null {
  if (movement === "hands") return reachAt(timeS);
  if (movement === "step") return marchingStep(timeS);
  if (movement !== "free") return null;
  return Math.floor(timeS / (4 * REACH_EVERY_S)) % 2 === 0 ? reachAt(timeS) : marchingStep(timeS);
}

/** Both hands in turn, in front of the chest and to the sides of it. */
function reachAt(timeS: number): ScriptedGoal {
  const count = Math.floor(timeS / REACH_EVERY_S);
  const limb = count % 2 === 0 ? "left" : "right";
  const side = limb === "left" ? -1 : 1;
  const [x, y] = count % 4 < 2 ? [0.15, 1.35] : [0.35, 1.1];
  return {
    kind: "reach",
    limb,
    targetM: [side * x, y, -0.45],
    nearM: 0.04,
    approachM: [0, 0, 0.15],
  };
}
