import { Model } from "survey-core";
import { describe, expect, it } from "vitest";
import type { Instrument } from "../api/types";
import { administration, instrument, words } from "./example";
import { answersOf, surveyJson } from "./surveyJson";

const options = { language: "en", words, mayOmit: false };
const model = (changed = {}) => new Model(surveyJson(administration, { ...options, ...changed }));

describe("an instrument as a SurveyJS form", () => {
  it("shows every item once, in the order the server drew", () => {
    const shown = model().getAllQuestions();
    expect(shown.map(({ name }) => name)).toEqual(administration.item_order);
  });

  it("speaks the language asked for", () => {
    const titles = model({ language: "de" })
      .getAllQuestions()
      .map(({ title }) => title);
    expect(titles[0]).toBe("Glasses (de)");
  });

  it("offers every step of the scale with its label", () => {
    const { rateValues } = model().getQuestionByName("calm");
    expect(rateValues.map(({ value }: { value: number }) => value)).toEqual([1, 2, 3, 4, 5]);
    expect(rateValues[0].text).toBe("strongly disagree");
  });

  it("names both ends where only they have labels", () => {
    const labels = [{ en: "low" }, { en: "high" }];
    const ends: Instrument = { ...instrument, scale: { minimum: 0, maximum: 20, labels } };
    const json = surveyJson({ ...administration, instrument: ends }, options);
    const question = new Model(json).getQuestionByName("calm");
    expect(question.rateValues).toHaveLength(21);
    expect([question.minRateDescription, question.maxRateDescription]).toEqual(["low", "high"]);
  });

  it("gives an item its own scale, in its own steps", () => {
    const labels = [{ en: "perfect" }, { en: "failure" }];
    const own = { minimum: 0, maximum: 100, step: 25, labels };
    const items = instrument.items.map((item) =>
      item.key === "calm" ? { ...item, scale: own } : item,
    );
    const json = surveyJson({ ...administration, instrument: { ...instrument, items } }, options);
    const question = new Model(json).getQuestionByName("calm");
    const values = question.rateValues.map(({ value }: { value: number }) => value);
    expect(values).toEqual([0, 25, 50, 75, 100]);
    expect(question.minRateDescription).toBe("perfect");
  });

  it("does not go on without the required answers, and says so in our words", () => {
    const form = model();
    expect(form.validate()).toBe(false);
    expect(form.getQuestionByName("calm").errors[0]?.getText()).toBe("Please answer.");
  });

  it("lets the operator leave out what was not answered", () => {
    expect(model({ mayOmit: true }).validate()).toBe(true);
  });

  it("refuses a number out of range and half a year", () => {
    const form = model({ mayOmit: true });
    form.setValue("age", 17);
    expect(form.validate()).toBe(false);
    form.setValue("age", 20.5);
    expect(form.validate()).toBe(false);
    form.setValue("age", 20);
    expect(form.validate()).toBe(true);
  });
});

describe("the answers of a form", () => {
  it("come back by item, with the type the server expects", () => {
    const form = model();
    form.data = { calm: 4, age: "31", hand: "left", glasses: "no", job: "baker" };
    expect(answersOf(instrument, form.data)).toEqual({
      calm: 4,
      age: 31,
      weight: null,
      hand: "left",
      glasses: false,
      job: "baker",
      problems: null,
    });
  });

  it("tell zero and no from nothing", () => {
    const answers = answersOf(instrument, { weight: 0, glasses: "no", problems: "" });
    expect(answers).toMatchObject({ weight: 0, glasses: false, problems: null, age: null });
  });
});
