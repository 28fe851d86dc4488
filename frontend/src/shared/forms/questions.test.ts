import { describe, expect, it } from "vitest";
import type { Instrument } from "../api/types";
import { administration, instrument, words } from "./example";
import { answersOf, firstProblem, problemOf, type Question, questionPages } from "./questions";

const options = { language: "en", words, canOmit: false };
const questions = (changed = {}, of = administration): readonly Question[] =>
  questionPages(of, { ...options, ...changed }).flat();
const questionOf = (key: string, changed = {}, of = administration): Question => {
  const found = questions(changed, of).find((one) => one.key === key);
  if (found === undefined) throw new Error(`no question ${key}`);
  return found;
};
const withItems = (change: Partial<Instrument>) => ({
  ...administration,
  instrument: { ...instrument, ...change },
});

describe("an instrument as a form", () => {
  it("shows every item once, in the order the server drew", () => {
    expect(questions().map(({ key }) => key)).toEqual(administration.item_order);
  });

  it("has one question on a page where it is asked for", () => {
    const pages = questionPages(administration, { ...options, isOnePerPage: true });
    expect(pages.map((page) => page.map(({ key }) => key))).toEqual(
      administration.item_order.map((key) => [key]),
    );
  });

  it("is in the requested language", () => {
    expect(questions({ language: "de" })[0]?.title).toBe("Glasses (de)");
  });

  it("marks the few optional questions as optional", () => {
    expect(questionOf("weight").title).toBe("Weight (optional)");
    expect(questionOf("weight", { canOmit: true }).title).toBe("Weight");
  });

  it("offers every step of the scale with its label", () => {
    const question = questionOf("calm");
    expect(question).toMatchObject({ kind: "rating", ends: null });
    expect(question.kind === "rating" && question.options.map(({ value }) => value)).toEqual([
      1, 2, 3, 4, 5,
    ]);
    expect(question.kind === "rating" && question.options[0]?.text).toBe("strongly disagree");
  });

  it("labels both ends if only they have labels", () => {
    const labels = [{ en: "low" }, { en: "high" }];
    const question = questionOf(
      "calm",
      {},
      withItems({ scale: { minimum: 0, maximum: 20, labels } }),
    );
    expect(question).toMatchObject({ kind: "rating", ends: ["low", "high"] });
    expect(question.kind === "rating" && question.options).toHaveLength(21);
  });

  it("shows an item's own scale with its own steps", () => {
    const labels = [{ en: "perfect" }, { en: "failure" }];
    const own = { minimum: 0, maximum: 100, step: 25, labels };
    const items = instrument.items.map((item) =>
      item.key === "calm" ? { ...item, scale: own } : item,
    );
    const question = questionOf("calm", {}, withItems({ items }));
    expect(question.kind === "rating" && question.options.map(({ value }) => value)).toEqual([
      0, 25, 50, 75, 100,
    ]);
  });
});

describe("the validation of a form", () => {
  it("blocks the next page until the required answers are given, and says so", () => {
    expect(problemOf(questionOf("calm"), undefined, words)).toBe("Please answer.");
    expect(problemOf(questionOf("job"), "   ", words)).toBe("Please answer.");
    expect(problemOf(questionOf("weight"), undefined, words)).toBeNull();
    expect(firstProblem(questions(), { glasses: "no" }, words)?.key).toBe("calm");
  });

  it("lets the operator omit what was not answered", () => {
    expect(firstProblem(questions({ canOmit: true }), {}, words)).toBeUndefined();
  });

  it("accepts zero and no as answers", () => {
    const scale = { minimum: 0, maximum: 4, labels: [] };
    expect(problemOf(questionOf("calm", {}, withItems({ scale })), 0, words)).toBeNull();
    expect(problemOf(questionOf("glasses"), "no", words)).toBeNull();
  });

  it("rejects a number out of range and half a year", () => {
    const age = questionOf("age");
    expect(problemOf(age, "17", words)).toBe("At least 18 years.");
    expect(problemOf(age, "111", words)).toBe("At most 110 years.");
    expect(problemOf(age, "20.5", words)).toBe("A whole number.");
    expect(problemOf(age, "20", words)).toBeNull();
    expect(problemOf(questionOf("weight"), "70.5", words)).toBeNull();
  });
});

describe("the answers of a form", () => {
  it("are returned by item, with the type the server expects", () => {
    const data = { calm: 4, age: "31", hand: "left", glasses: "no", job: "baker" };
    expect(answersOf(instrument, data)).toEqual({
      calm: 4,
      age: 31,
      weight: null,
      hand: "left",
      glasses: false,
      job: "baker",
      problems: null,
    });
  });

  it("distinguish zero and no from a missing answer", () => {
    const answers = answersOf(instrument, { weight: 0, glasses: "no", problems: "" });
    expect(answers).toMatchObject({ weight: 0, glasses: false, problems: null, age: null });
  });
});
