import { AXES } from "@shared/avatar/anatomy.generated";
import { describe, expect, it } from "vitest";
import { axisName, isFound } from "./axes";
import { avatarChangesDe, avatarChangesEn } from "./texts";

type T = Parameters<typeof axisName>[0]["t"];

const speaking = (words: Readonly<Record<string, string>>): { t: T } => ({
  t: ((key: string, values: Readonly<Record<string, string>> = {}) => {
    const text = words[key];
    if (text === undefined) throw new Error(`no text for ${key}`);
    return text.replace(/\{\{(\w+)\}\}/g, (_, name: string) => values[name] ?? "");
  }) as T,
});
const english = speaking(avatarChangesEn);
const german = speaking(avatarChangesDe);

describe("the name of an axis", () => {
  it("says the joint and the movement in both languages", () => {
    expect(axisName(english, "LeftLowerArmY")).toBe("left elbow: bend");
    expect(axisName(german, "LeftLowerArmY")).toBe("linker Ellbogen: beugen");
    expect(axisName(german, "RightIndexDistalZ")).toBe(
      "rechter Zeigefinger, drittes Gelenk: beugen",
    );
    expect(axisName(english, "HeadX")).toBe("head: bend forward");
  });

  it("is another one for each axis of the body, and never its code", () => {
    for (const texts of [english, german]) {
      const names = AXES.map(({ name }) => axisName(texts, name));
      expect(new Set(names).size).toBe(AXES.length);
      for (const name of names) expect(name).toContain(": ");
    }
  });

  it("is found by any of its words and by its code", () => {
    expect(isFound("bend elb", "left elbow: bend", "LeftLowerArmY")).toBe(true);
    expect(isFound("lowerarmy", "left elbow: bend", "LeftLowerArmY")).toBe(true);
    expect(isFound("knee", "left elbow: bend", "LeftLowerArmY")).toBe(false);
  });

  it("stays as it is where a body does not have it", () => {
    expect(axisName(english, "TailX")).toBe("TailX");
  });
});
