import { length, minus, rotate, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { looksRaised, StopGesture } from "../../panels";
import type { TaskLayout } from "../../tasks";
import { readLayouts } from "../../tasks/testing/layouts";
import { type ArmPose, goalOn, ScriptedPerson, ScriptSource } from "../../tracking/script";
import { INDEX } from "../../tracking/skeleton";

const RATE_HZ = 90;
const PHASE_S = 60;
/** Whoever has not arrived after this goes on to the next box. */
const PATIENCE_S = 3;
const SIDES = ["left", "right"] as const;

const layoutOf = (name: string): TaskLayout => {
  const layout = readLayouts().get(name);
  if (layout === undefined) throw new Error(`no layout ${name}`);
  return layout;
};

/** The same boxes, nearer to the floor. */
const lowered = (layout: TaskLayout, byM: number) => ({
  limb: layout.limb,
  surfaces: layout.surfaces.map((surface) => {
    const [x, y, z] = surface.centerM;
    return { ...surface, centerM: [x, y - byM, z] as const };
  }),
});

/** Stops, and frames in which one was on its way, while somebody moves for some seconds. */
function stopsOf(
  person: ScriptedPerson,
  seconds: number,
  direct: (timeS: number) => void,
  highestM = 0,
): { readonly stops: number; readonly shown: number } {
  const source = new ScriptSource(person, { worn: {} });
  const gesture = new StopGesture();
  const found = { stops: 0, shown: 0 };
  for (let frame = 0; frame < seconds * RATE_HZ; frame++) {
    const timeS = frame / RATE_HZ;
    direct(timeS);
    const tracked = source.read(timeS);
    const needsBothHands = looksRaised(highestM, tracked.eyes?.positionM[1] ?? 0);
    const progress = gesture.update(tracked, { needsBothHands });
    if (progress !== null) found.shown++;
    if (progress?.share === 1) found.stops++;
  }
  return found;
}

/** Touch one box after the other and the target, again and again, as the rules would ask. */
function task(
  person: ScriptedPerson,
  layout: Pick<TaskLayout, "limb" | "surfaces">,
  hand: "left" | "right",
) {
  const goals = layout.surfaces.filter(({ kind }) => kind === "panel" || kind === "target");
  let [at, sinceS] = [0, 0];
  const context = {
    limb: layout.limb,
    surfaces: layout.surfaces,
    writingHand: hand,
    leadingFoot: hand,
    countingFoot: null,
    greenCount: 0,
    isSolid: false,
  };
  let touched = 0;
  const direct = (timeS: number) => {
    const goal = goalOn(goals[at % goals.length] ?? null, { ...context, greenCount: at });
    if (goal === null) return;
    const isThere = layout.limb === "hand" && distance(person, hand, goal.targetM) < 0.06;
    if (isThere || timeS - sinceS > PATIENCE_S) {
      if (isThere) touched++;
      at++;
      sinceS = timeS;
    }
    person.pursue(goal);
  };
  return { direct, touched: () => touched };
}

function distance(person: ScriptedPerson, side: "left" | "right", pointM: Vector): number {
  const hand = INDEX[side === "left" ? "LeftHand" : "RightHand"];
  const along: Vector = [(side === "left" ? -1 : 1) * person.skeleton.handM, 0, 0];
  const { positionsM, rotations } = person.joints;
  const turned = rotate(rotations[hand] ?? [1, 0, 0, 0], along);
  const [x, y, z] = positionsM[hand] ?? [0, 0, 0];
  return length(minus(pointM, [x + turned[0], y + turned[1], z + turned[2]]));
}

describe("ordinary movement", () => {
  it.each([
    [1.52, "boxes as high as in the shipped study", 1.48],
    [1.95, "boxes as high as in the shipped study", 1.48],
    // Its target hangs 20 cm above their eyes.
    [1.52, "high boxes", 1.6875],
  ])("never stops a hand phase of somebody of %f m at %s", (statureM, _, highestM) => {
    const layout = lowered(layoutOf("hand"), 1.6875 - highestM);
    for (const hand of SIDES) {
      const person = new ScriptedPerson({ statureM, seed: 3 });
      const { direct, touched } = task(person, layout, hand);
      expect(stopsOf(person, PHASE_S, direct, highestM)).toEqual({ stops: 0, shown: 0 });
      expect(touched()).toBeGreaterThan(10);
    }
  });

  it.each([1.52, 1.95])("never stops a foot phase of somebody of %f m", (statureM) => {
    for (const foot of SIDES) {
      const person = new ScriptedPerson({ statureM, seed: 4 });
      const { direct } = task(person, layoutOf("foot"), foot);
      expect(stopsOf(person, PHASE_S, direct)).toEqual({ stops: 0, shown: 0 });
    }
  });

  it("is not the poses of the calibration either; a raised hand is", () => {
    const poses: readonly ArmPose[] = ["n_pose", "t_pose", "forward", "ease"];
    const stopsAt = (pose: ArmPose) => {
      const person = new ScriptedPerson({ statureM: 1.75, seed: 5 });
      return stopsOf(person, 4, (timeS) => person.take(timeS < 1 ? "ease" : pose)).stops;
    };
    expect(poses.map(stopsAt)).toEqual([0, 0, 0, 0]);
    expect([stopsAt("left_up"), stopsAt("right_up")]).toEqual([1, 1]);
  });
});
