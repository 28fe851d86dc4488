import { readFileSync } from "node:fs";
import { uploadUrl } from "@shared/api/captures";
import { BODY } from "@shared/bodyJoints";
import { describe, expect, it } from "vitest";
import { avatarOf, withAvatar } from "./avatars";
import { GROUPS, placeOnBody, rolesFrom } from "./bodyJoints";
import { assign, begin, problemsOf, redo, replace, sameMap, undo } from "./jointMapEdit";
import { missingCompanion, pairFiles } from "./useUploads";

const named = (...names: string[]) => names.map((name) => ({ name }));
const pairs = (...names: string[]) =>
  pairFiles(named(...names)).ready.map(({ file, companion }) => [file.name, companion?.name]);

describe("files that belong together", () => {
  it("are an AMC and the ASF whose name it starts with; others are uploaded alone", () => {
    expect(pairs("walk.bvh", "02_01.amc", "02.asf", "02_06.AMC", "5.asf")).toEqual([
      ["walk.bvh", undefined],
      ["02_01.amc", "02.asf"],
      ["02_06.AMC", "02.asf"],
    ]);
  });

  it("are the only ASF and the only AMC, whatever they are called", () => {
    expect(pairs("take.amc", "skeleton.asf")).toEqual([["take.amc", "skeleton.asf"]]);
  });

  it("wait for each other, and the missing one is named", () => {
    const { ready, lonely } = pairFiles(named("02_01.amc"));
    expect(ready).toEqual([]);
    expect(lonely.map(missingCompanion)).toEqual([".asf"]);
    expect(pairFiles(named("02.asf")).lonely.map(missingCompanion)).toEqual([".amc"]);
  });

  it("are sent as one body, which ends with the companion", () => {
    const file = new File(["frames"], "02 ä.amc");
    const companion = new File(["bones"], "02.asf");
    const query = new URL(uploadUrl({ file, companion }), "http://localhost").searchParams;
    expect(Object.fromEntries(query)).toEqual({
      name: "02 ä.amc",
      companion: "02.asf",
      companion_bytes: "5",
    });
    expect(uploadUrl({ file, companion: null })).not.toContain("companion");
  });
});

const RIG = { names: ["root", "thigh", "shin", "foot"], parents: [-1, 0, 1, 2] };
const LEGS = { Hips: "root", LeftUpperLeg: "thigh", LeftLowerLeg: "shin" };

describe("editing a joint map", () => {
  it("can be undone and redone, step by step", () => {
    const first = begin(LEGS);
    const second = assign(first, "LeftFoot", "foot");
    const third = assign(second, "LeftLowerLeg", null);
    expect(third.present).toEqual({ Hips: "root", LeftUpperLeg: "thigh", LeftFoot: "foot" });
    expect(undo(third).present).toEqual(second.present);
    expect(undo(undo(third)).present).toEqual(LEGS);
    expect(undo(undo(undo(third))).present).toEqual(LEGS);
    expect(redo(undo(third)).present).toEqual(third.present);
    expect(redo(third)).toBe(third);
  });

  it("forgets what was undone after another change", () => {
    const edit = assign(undo(assign(begin(LEGS), "LeftFoot", "foot")), "LeftUpperLeg", null);
    expect(redo(edit)).toBe(edit);
  });

  it("adds no step if nothing changes, and one step for a whole map", () => {
    const edit = begin(LEGS);
    expect(assign(edit, "Hips", "root")).toBe(edit);
    expect(assign(edit, "Head", null)).toBe(edit);
    expect(undo(replace(edit, { Hips: "thigh" })).present).toBe(LEGS);
    expect(sameMap({ a: "1", b: "2" }, { b: "2", a: "1" })).toBe(true);
    expect(sameMap({ a: "1" }, { a: "1", b: "2" })).toBe(false);
  });

  it("reports what the server would reject", () => {
    expect(problemsOf(LEGS, BODY, RIG).size).toBe(0);
    expect(problemsOf({ LeftFoot: "foot" }, BODY, RIG).get("Hips")).toEqual({ kind: "hips" });
    const twice = problemsOf({ ...LEGS, LeftFoot: "shin" }, BODY, RIG);
    expect(twice.get("LeftFoot")).toEqual({ kind: "twice", other: "LeftLowerLeg" });
    const swapped = { Hips: "root", LeftUpperLeg: "foot", LeftFoot: "thigh" };
    expect(problemsOf(swapped, BODY, RIG).get("LeftFoot")).toEqual({
      kind: "order",
      above: "LeftUpperLeg",
      aboveJoint: "foot",
    });
  });
});

describe("the body", () => {
  it("has the joints and the hierarchy of the server's", () => {
    const file = new URL("../../../../app/science/skeleton/joints.py", import.meta.url);
    const lines = readFileSync(file, "utf-8").matchAll(/^ {4}"(\w+)": (?:"(\w+)"|None),$/gm);
    const parents = Object.fromEntries([...lines].map(([, name, above]) => [name, above ?? null]));
    expect(BODY).toEqual(parents);
    expect(Object.values(GROUPS).flat().toSorted()).toEqual(Object.keys(BODY).toSorted());
  });

  it("is drawn from the front, with left and right apart", () => {
    expect(placeOnBody("LeftHand")[0]).toBeGreaterThan(0);
    expect(placeOnBody("RightHand")[0]).toBe(-placeOnBody("LeftHand")[0]);
  });

  it("is found in a skeleton by its joint map", () => {
    const roles = rolesFrom(RIG.names, LEGS);
    expect(roles).toMatchObject({ head: null, leftHip: 1, rightHip: null });
    expect([...roles.left]).toEqual([1, 2]);
  });
});

describe("avatars", () => {
  it("are named by a stature that the server accepts", () => {
    expect([165, "172.5", 172.46].map(avatarOf)).toEqual(["165cm", "172.5cm", "172.5cm"]);
    expect([49, 261, "", "tall"].map(avatarOf)).toEqual([null, null, null, null]);
  });

  it("are listed in order of stature, without duplicates", () => {
    expect(withAvatar(["130cm", "190cm"], "165cm")).toEqual(["130cm", "165cm", "190cm"]);
    expect(withAvatar(["95.5cm", "130cm"], "130cm")).toEqual(["95.5cm", "130cm"]);
  });
});
