import { administration, words } from "@shared/forms/example";
import { startFilling } from "@shared/forms/filling";
import { questionPages } from "@shared/forms/questions";
import { newForm } from "@shared/forms/storedForms";
import { describe, expect, it } from "vitest";
import { choose, continued, type EarlyForm, joined, takesBack } from "./earlyForm";

const START = new Date("2026-01-01T12:00:00Z");
const later = (s: number) => new Date(START.getTime() + s * 1000);
const { instrument } = administration;
const free = instrument.items.map((item) =>
  item.type === "choice" ? { ...item, required: false } : item,
);
const asked = { ...administration, instrument: { ...instrument, items: free } };
const questions = questionPages(asked, { language: "en", words, canOmit: false })
  .flat()
  .filter((one) => "options" in one);
const required = questions.find((one) => one.required);
const optional = questions.find((one) => !one.required);

function early(at = START): EarlyForm {
  const form = newForm("session", administration.key, at);
  return { form, filling: startFilling(form.draft, performance.now()), questions };
}

const firstValue = (question: typeof required): string | number => {
  if (question === undefined || !("options" in question)) throw new Error("no such question");
  return question.options[0]?.value ?? "";
};

describe("an answer before the application is there", () => {
  it("is kept with its time, as the value that the option stands for", () => {
    const { key = "" } = required ?? {};
    const value = firstValue(required);
    const { form, filling } = choose(early(), key, String(value), later(2.5));
    expect(form.draft.data).toEqual({ [key]: value });
    expect(form.draft.timings).toEqual({ [key]: 2.5 });
    expect(form.draft.traces[key]?.changes).toBe(0);
    expect(filling.draft).toBe(form.draft);
    expect(filling.turn.item).toBe(key);
  });

  it("can be taken back only where none is required", () => {
    for (const [question, isFree] of [
      [required, false],
      [optional, true],
    ] as const) {
      const { key = "" } = question ?? {};
      const value = String(firstValue(question));
      const answered = choose(early(), key, value, later(1));
      expect(takesBack(early(), key, value)).toBe(false);
      expect(takesBack(answered, key, value)).toBe(isFree);
      expect(choose(answered, key, null, later(2)).form.draft.data).toEqual({});
    }
  });

  it("is no answer to a question of another page", () => {
    const before = early();
    expect(choose(before, "elsewhere", "1", later(1))).toBe(before);
  });
});

describe("an early form that is stored already", () => {
  const { key = "" } = required ?? {};
  const value = firstValue(required);
  const answered = choose(early(later(60)), key, String(value), later(62));

  it("keeps the key and the start of what is stored, and its answers count from there", () => {
    const stored = newForm("session", administration.key, START);
    const { form, filling } = continued(answered, stored);
    expect(form.idempotencyKey).toBe(stored.idempotencyKey);
    expect(form.startedAt).toBe(stored.startedAt);
    expect(form.draft.timings).toEqual({ [key]: 62 });
    expect(filling.draft).toBe(form.draft);
  });

  it("adds its answers to those that are stored, on the page that is stored", () => {
    const draft = { data: { other: 3, [key]: null }, page: 2, timings: { other: 9 }, traces: {} };
    const stored = { ...newForm("session", administration.key, START), draft };
    const both = joined(stored, answered.form).draft;
    expect(both.data).toEqual({ other: 3, [key]: value });
    expect(both.page).toBe(2);
    expect(both.timings).toEqual({ other: 9, [key]: 62 });
  });
});
