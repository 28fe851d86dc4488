import type { Limb, StepKind } from "@shared/api/types";
import { registryEn, STEP_KINDS } from "@shared/session/registries.generated";
import { describe, expect, it } from "vitest";
import { isForm, isTimed, stepIcon, stepName, stepText } from "./steps";

const kinds = Object.keys(STEP_KINDS) as StepKind[];
/** Every kind of step with each of its limbs, as plans contain them. */
const steps = kinds.flatMap((kind) => {
  const { limbs } = STEP_KINDS[kind];
  const named: readonly (Limb | null)[] = limbs.length > 0 ? limbs : [null];
  return named.map((limb) => ({ kind, limb }));
});

describe("a step", () => {
  it("has a name and guidance, and a button if it is timed", () => {
    for (const step of steps) {
      expect(registryEn).toHaveProperty([stepName(step)]);
      expect(registryEn).toHaveProperty([stepText("guide", step)]);
      if (isTimed(step)) expect(registryEn).toHaveProperty([stepText("do.begin", step)]);
    }
  });

  it("has a button that completes it exactly if the table says so", () => {
    for (const kind of kinds) {
      const { isCompletedByButton } = STEP_KINDS[kind];
      expect([kind, `do.complete.${kind}` in registryEn]).toEqual([kind, isCompletedByButton]);
    }
  });

  it("shows the icon of its limb, otherwise of its kind", () => {
    expect(stepIcon({ kind: "practice", limb: "foot" })).toBe("foot");
    expect(stepIcon({ kind: "free_roam", limb: null })).toBe("walk");
  });

  it("keeps its own name and icon after a task with a limb", () => {
    const step = { kind: "questionnaire", limb: "hand" } as const;
    expect(isForm(step)).toBe(true);
    expect(stepName(step)).toBe("step.questionnaire");
    expect(stepIcon(step)).toBe("form");
  });
});
