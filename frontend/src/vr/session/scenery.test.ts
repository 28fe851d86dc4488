import { describe, expect, it } from "vitest";
import type { World, WorldFrame } from "../world";
import type { View } from "./ports";
import { WorldScenery } from "./scenery";
import { FakeSource, STATE } from "./testing";

/** A world that notes what it is told. */
function scene() {
  const shown: WorldFrame[] = [];
  const staturesM: number[] = [];
  const world: Pick<World, "show" | "wear"> = {
    show: (one) => void shown.push(one),
    wear: (_, statureM) => void staturesM.push(statureM),
  };
  const scenery = new WorldScenery(world as World, ["hand"]);
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
