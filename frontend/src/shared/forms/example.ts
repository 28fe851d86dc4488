/** A small instrument for tests: one item of every type. */
import type { Administration, Instrument, Item } from "../api/types";
import type { FormWords } from "./questions";

const text = (en: string) => ({ en, de: `${en} (de)` });

export const likert = (key: string): Item => ({ key, text: text(key), type: "likert" });

const SCALE = ["strongly disagree", "disagree", "neither", "agree", "strongly agree"];

export const instrument: Instrument = {
  key: "example",
  version: 1,
  title: text("Example"),
  languages: ["en", "de"],
  scale: { minimum: 1, maximum: 5, labels: SCALE.map(text) },
  items: [
    likert("calm"),
    { key: "age", text: text("Age"), type: "integer", minimum: 18, maximum: 110, unit: "years" },
    { key: "weight", text: text("Weight"), type: "number", required: false, unit: "kg" },
    {
      key: "hand",
      text: text("Hand"),
      type: "choice",
      choices: [
        { key: "left", label: text("Left") },
        { key: "right", label: text("Right") },
      ],
    },
    { key: "glasses", text: text("Glasses"), type: "boolean" },
    { key: "job", text: text("Job"), type: "text", max_length: 100 },
    { key: "problems", text: text("Problems"), type: "text", required: false },
  ],
};

export const administration: Administration = {
  key: "example#1",
  step_index: 1,
  instrument,
  item_order: ["glasses", "calm", "age", "weight", "hand", "job", "problems"],
  seed: 7,
  language: "en",
  languages: ["en", "de"],
};

export const words: FormWords = {
  yes: "Yes",
  no: "No",
  optional: "optional",
  required: "Please answer.",
  range: (low, high, unit) => `${low} to ${high} ${unit}`,
  whole: "A whole number.",
  atLeast: (low, unit) => `At least ${low} ${unit}.`,
  atMost: (high, unit) => `At most ${high} ${unit}.`,
};
