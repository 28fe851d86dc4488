import { length, minus, plus, rotate, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { INDEX, type Joint } from "../skeleton";
import { type GoalSurface, goalOn } from "./goals";
import type { ScriptedGoal } from "./movements";
import { type PersonOptions, ScriptedPerson } from "./person";
import { ScriptSource } from "./source";

const RATE_HZ = 90;
const STILL: PersonOptions = { statureM: 1.75, seed: 7, restlessness: 0 };

/** Let a person move for some seconds, and look at every frame. */
function watch(person: ScriptedPerson, fromS: number, seconds: number, look?: () => void): number {
  const frames = Math.round(seconds * RATE_HZ);
  for (let frame = 1; frame <= frames; frame++) {
    person.advance(fromS + frame / RATE_HZ);
    look?.();
  }
  return fromS + frames / RATE_HZ;
}

const at = (person: ScriptedPerson, joint: Joint): Vector =>
  person.joints.positionsM[INDEX[joint]] as Vector;

function tipOf(person: ScriptedPerson, side: "Left" | "Right"): Vector {
  const hand = INDEX[`${side}Hand`];
  const along: Vector = [side === "Left" ? -person.skeleton.handM : person.skeleton.handM, 0, 0];
  const rotation = person.joints.rotations[hand] as [number, number, number, number];
  return plus(at(person, `${side}Hand`), rotate(rotation, along));
}

const box: GoalSurface = {
  kind: "panel",
  box: 1,
  centerM: [0.3, 1.2, -0.62],
  halfSizeM: [0.1, 0.1, 0.01],
};
const walls: GoalSurface = {
  kind: "side",
  box: 1,
  centerM: [0.2, 1.2, -0.5],
  halfSizeM: [0.01, 0.1, 0.11],
};
const context = {
  limb: "hand",
  surfaces: [box, walls],
  writingHand: "right",
  leadingFoot: "right",
  countingFoot: null,
  greenCount: 0,
  isSolid: true,
} as const;

describe("A scripted person", () => {
  it.each([
    [1.53, 1.5],
    [1.75, 1.8],
    [1.88, 1.97],
  ])(
    "of %f m and a span of %f m has this span in the T-pose, upright, arms level",
    (statureM, spanM) => {
      const person = new ScriptedPerson({ ...STILL, statureM, spanM });
      person.take("t_pose");
      watch(person, 0, 2);
      const span = minus(tipOf(person, "Right"), tipOf(person, "Left"));
      expect(length(span)).toBeCloseTo(spanM, 4);
      expect(Math.abs(span[1])).toBeLessThan(1e-4);
      expect(at(person, "Head")[1]).toBeGreaterThan(0.873 * statureM);
      expect(at(person, "Head")[1]).toBeLessThan(0.8751 * statureM);
    },
  );

  it("hangs its arms straight down in the N-pose, and stands on the floor", () => {
    const person = new ScriptedPerson(STILL);
    person.take("n_pose");
    watch(person, 0, 2);
    const arm = minus(tipOf(person, "Left"), at(person, "LeftUpperArm"));
    expect(Math.hypot(arm[0], arm[2])).toBeLessThan(1e-3);
    expect(at(person, "LeftFoot")[1]).toBeCloseTo(0.039 * 1.75, 6);
  });

  it("touches the back of a box through its opening, and leaves it the same way", () => {
    const person = new ScriptedPerson({ ...STILL, restlessness: 1 });
    const goal = goalOn(box, context) as ScriptedGoal;
    person.pursue(goal);
    let timeS = watch(person, 0, 4);
    const tip = tipOf(person, "Right");
    expect(Math.abs(tip[0] - 0.3)).toBeLessThan(0.06);
    expect(Math.abs(tip[1] - 1.2)).toBeLessThan(0.06);
    expect(tip[2]).toBeLessThan(-0.61);
    person.pursue({ ...goal, targetM: [-0.3, 1.2, -0.61] });
    let isInside = true;
    let deepest = 0;
    timeS = watch(person, timeS, 3, () => {
      const [x, , z] = tipOf(person, "Right");
      if (z > -0.5) isInside = false;
      if (!isInside) deepest = Math.min(deepest, z);
      if (isInside) expect(Math.abs(x - 0.3)).toBeLessThan(0.1);
    });
    expect(isInside).toBe(false);
    expect(deepest).toBeLessThan(-0.61);
  });

  it("steps into a box on the floor over its edge, and walks back to the square", () => {
    const person = new ScriptedPerson(STILL);
    const target: Vector = [0.3, 0, -0.7];
    const goal: ScriptedGoal = {
      kind: "step",
      limb: "right",
      targetM: target,
      nearM: 0.06,
      approachM: [0, 0.18, 0],
    };
    person.pursue(goal);
    let highest = 0;
    const timeS = watch(person, 0, 6, () => {
      highest = Math.max(highest, at(person, "RightFoot")[1]);
    });
    const foot = at(person, "RightFoot");
    expect(Math.hypot(foot[0] - 0.3, foot[2] - (-0.7 + 0.038 * 1.75))).toBeLessThan(0.08);
    expect(foot[1]).toBeCloseTo(0.039 * 1.75, 3);
    expect(highest).toBeGreaterThan(0.17);
    person.pursue({
      kind: "walk_to",
      limb: null,
      targetM: [0, 0, 0],
      nearM: 0.1,
      approachM: [0, 0.18, 0],
    });
    watch(person, timeS, 8);
    expect(Math.hypot(person.rootM[0], person.rootM[2])).toBeLessThan(0.05);
  });

  it("moves the same for the same seed, and otherwise for another", () => {
    const path = (seed: number) => {
      const person = new ScriptedPerson({ statureM: 1.7, seed });
      person.pursue(goalOn(box, context));
      watch(person, 0, 2);
      return tipOf(person, "Right");
    };
    expect(path(3)).toEqual(path(3));
    expect(path(3)).not.toEqual(path(4));
  });

  it("moves no part faster than people do, whatever it is told", () => {
    const person = new ScriptedPerson({ statureM: 1.7, seed: 5 });
    let before = person.joints.positionsM.map((place) => place);
    let fastest = 0;
    const look = () => {
      for (const [joint, place] of person.joints.positionsM.entries()) {
        fastest = Math.max(fastest, RATE_HZ * length(minus(place, before[joint] as Vector)));
      }
      before = [...person.joints.positionsM];
    };
    person.take("t_pose");
    let timeS = watch(person, 0, 1.5, look);
    person.pursue(goalOn(box, context));
    timeS = watch(person, timeS, 2, look);
    person.pursue({
      kind: "step",
      limb: "left",
      targetM: [-0.4, 0, -0.8],
      nearM: 0.06,
      approachM: [0, 0.2, 0],
    });
    timeS = watch(person, timeS, 4, look);
    person.pursue(null);
    person.squat = 1;
    timeS = watch(person, timeS, 2, look);
    person.pointAt("right", [0.2, 1.5, -2]);
    watch(person, timeS, 1, look);
    expect(fastest).toBeLessThan(5);
  });

  it("refuses a time before the last one", () => {
    const person = new ScriptedPerson(STILL);
    person.advance(1);
    expect(() => person.advance(0.5)).toThrow(/from 1 s to 0.5 s/);
  });
});

describe("A scripted source", () => {
  it("gives joints without devices, and devices at their offsets with them", () => {
    const joints = new ScriptSource(new ScriptedPerson(STILL));
    const worn = new ScriptSource(new ScriptedPerson(STILL), { worn: {}, hasWaist: true });
    const bare = joints.read(0.5);
    const dressed = worn.read(0.5);
    expect(joints.knownBody).toEqual({ statureM: 1.75, spanM: expect.closeTo(1.9915, 4) });
    expect(worn.knownBody).toBeNull();
    expect(bare.parts.Hips).toEqual({ place: null, state: "inferred", device: null });
    expect(dressed.parts.Hips.state).toBe("tracked");
    expect(dressed.eyes?.positionM[1]).toBeCloseTo(0.936 * 1.75, 1);
    expect(bare.eyes).toEqual(dressed.eyes);
    const knee = bare.parts.LeftLowerLeg.place?.positionM as Vector;
    const tracker = dressed.parts.LeftLowerLeg.place?.positionM as Vector;
    expect(length(minus(knee, tracker))).toBeCloseTo(Math.hypot(0.012, 0.09 * 1.75, 0.055), 6);
  });

  it("with exchanged trackers puts the left one on the right shin", () => {
    const right = new ScriptSource(new ScriptedPerson(STILL), { worn: {} }).read(0.1);
    const swapped = new ScriptSource(new ScriptedPerson(STILL), {
      worn: { swapped: "shins" },
    }).read(0.1);
    expect(right.parts.LeftLowerLeg.place?.positionM[0]).toBeLessThan(0);
    expect(swapped.parts.LeftLowerLeg.place?.positionM[0]).toBeGreaterThan(0);
  });
});
