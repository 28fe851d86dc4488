import { describe, expect, it } from "vitest";
import type { CompanionLink } from "../companion";
import { BoxRun, type TaskLayout, TaskRules } from "../tasks";
import { readLayouts } from "../tasks/testing/layouts";
import type { World, WorldFrame } from "../world";
import type { View } from "./ports";
import { WorldScenery } from "./scenery";
import { FakeSource, ORDER, STATE } from "./testing";

/** A world that notes what it is told. */
function scene() {
  const shown: WorldFrame[] = [];
  const staturesM: number[] = [];
  const world: Pick<World, "show" | "wear"> = {
    show: (one) => void shown.push(one),
    wear: (_, statureM) => void staturesM.push(statureM),
  };
  const scenery = new WorldScenery(world as World, ["hand"], () => null);
  const state = { ...STATE, participant: { ...STATE.participant, stature_m: 1.62 } };
  const show = (place: View["place"], step: string | null, stepKind = "materialise") => {
    const prompt = step === null ? null : { step, number: 1, total: 6, problem: null };
    scenery.show({
      timeS: 1,
      place,
      state: { ...state, step_kind: stepKind },
      tracked: new FakeSource().read(1),
      bodies: null,
      run: null,
      street: null,
      isFrozen: false,
      calibration: prompt as View["calibration"],
      cover: "none",
    });
    return shown.at(-1)?.visible.figure;
  };
  return { show, staturesM };
}

describe("the transparent figure", () => {
  it("stands there before anything is measured, at the stated stature, and then to be entered", () => {
    const { show, staturesM } = scene();
    expect(show("calibrating", "square")).toBe(true);
    expect(staturesM).toEqual([1.62]);
    expect(show("calibrating", "t_pose")).toBe(false);
    expect(show("stepping_in", null)).toBe(true);
    // What was measured counts from here on, whatever was stated.
    expect(staturesM).toEqual([1.62]);
    expect(show("acting", null, "free_roam")).toBe(false);
  });

  it("is what the height is compared with", () => {
    const { show } = scene();
    expect(show("standby", null, "height")).toBe(true);
    expect(show("standby", null, "instructions")).toBe(false);
  });
});

describe("the companion", () => {
  const POSE = [1, 2, 3];

  /** What is shown of a companion in a moment, and whether they count as seen. */
  function looking(isInTasks: boolean) {
    const shown: WorldFrame[] = [];
    const seen: boolean[] = [];
    const world = { show: (one: WorldFrame) => void shown.push(one), wear: () => undefined };
    const look = (wants: boolean) => {
      seen.push(wants);
      return wants ? POSE : null;
    };
    const companion = { isInTasks, look } as unknown as CompanionLink;
    const scenery = new WorldScenery(world as unknown as World, ["hand"], () => companion);
    return (moment: Partial<View> = {}) => {
      scenery.show({
        timeS: 1,
        place: "acting",
        state: STATE,
        tracked: new FakeSource().read(1),
        bodies: {} as View["bodies"],
        run: null,
        street: null,
        isFrozen: false,
        calibration: null,
        cover: "none",
        ...moment,
      });
      return [shown.at(-1)?.companion ?? null, seen.at(-1)];
    };
  }
  const unseen = [null, false];

  it("is there between tasks, and not in any other place of the visit", () => {
    const look = looking(false);
    expect(look()).toEqual([POSE, true]);
    expect(look({ place: "standby" })).toEqual(unseen);
    expect(look({ bodies: null })).toEqual(unseen);
    expect(look({ street: {} as View["street"] })).toEqual(unseen);
    expect(look({ calibration: {} as View["calibration"] })).toEqual(unseen);
  });

  it("is there in a task only if the experimenter wants it so", () => {
    const layout = readLayouts().get("hand") as TaskLayout;
    const run = new BoxRun({ ...ORDER, limb: "hand" }, new TaskRules(layout, "right"), [], 0);
    expect(looking(false)({ run })).toEqual(unseen);
    expect(looking(true)({ run })).toEqual([POSE, true]);
  });

  it("stays until the curtain has closed, and is not seen meanwhile", () => {
    const look = looking(false);
    look();
    expect(look({ cover: "fade" })).toEqual([POSE, false]);
    expect(look({ cover: "cut" })).toEqual(unseen);
    expect(look({ cover: "fade" })).toEqual(unseen);
  });
});
