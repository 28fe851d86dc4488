import type { Form } from "@shared/api/rights";
import type { Item } from "@shared/api/types";
import { describe, expect, it } from "vitest";
import { answerText } from "./answerText";

const words = { leftOut: "left out", yes: "yes", no: "no" };
const ends = [{ en: "not at all" }, { en: "fully" }];
const form = {
  definition: { scale: { minimum: 1, maximum: 7, labels: ends } },
} as unknown as Form;
const item = (fields: Partial<Item>) => ({ key: "q", text: { en: "?" }, ...fields }) as Item;

describe("an answer in words", () => {
  it("shows the label of a step if it has one, otherwise the number", () => {
    const likert = item({ type: "likert" });
    const texts = [1, 4, 7].map((value) => answerText(form, likert, value, "en", words));
    expect(texts).toEqual(["1 (not at all)", "4", "7 (fully)"]);
  });

  it("shows yes and no as they are stored, a choice by its label, a number with its unit", () => {
    expect(answerText(form, item({ type: "boolean" }), 1, "en", words)).toBe("yes");
    expect(answerText(form, item({ type: "boolean" }), 0, "en", words)).toBe("no");
    const choice = item({ type: "choice", choices: [{ key: "left", label: { en: "Left" } }] });
    expect(answerText(form, choice, "left", "en", words)).toBe("Left");
    expect(answerText(form, item({ type: "integer", unit: "cm" }), 173, "en", words)).toBe(
      "173 cm",
    );
    expect(answerText(form, choice, null, "en", words)).toBe("left out");
  });
});
