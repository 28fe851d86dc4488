/** An instrument as the JSON that SurveyJS draws, and its answers back again. */
import type { Administration, Answer, Choice, Instrument, Item, Scale } from "../api/types";
import { inLanguage } from "../text";
import { isLong, pagesOf } from "./pages";

export interface FormWords {
  readonly yes: string;
  readonly no: string;
  readonly optional: string;
  /** Said where an answer is missing. */
  readonly required: string;
  /** What a number may be: `{low}`, `{high}` and `{unit}` are filled in. */
  readonly range: (low: number | null, high: number | null, unit: string) => string;
}

export interface FormOptions {
  readonly language: string;
  readonly words: FormWords;
  /** The operator may leave out what the participant did not answer. */
  readonly mayOmit: boolean;
}

type Json = Readonly<Record<string, unknown>>;

export function surveyJson(administration: Administration, options: FormOptions): Json {
  const { instrument, item_order } = administration;
  const byKey = new Map(instrument.items.map((item) => [item.key, item]));
  const ordered = item_order.flatMap((key) => byKey.get(key) ?? []);
  return {
    showTitle: false,
    showNavigationButtons: "none",
    showQuestionNumbers: "off",
    showProgressBar: false,
    autoFocusFirstQuestion: false,
    autoFocusFirstError: true,
    checkErrorsMode: "onNextPage",
    textUpdateMode: "onTyping",
    questionErrorLocation: "bottom",
    requiredMark: "",
    // Which question is required is said in words, at the few that are not.
    pages: pagesOf(ordered, (item) => stepsOf(item.scale ?? instrument.scale ?? null).length).map(
      (items, index) => ({
        name: `page${index + 1}`,
        elements: items.map((item) => element(item, instrument, options)),
      }),
    ),
  };
}

const isRequired = (item: Item): boolean => item.required !== false;

function element(item: Item, instrument: Instrument, options: FormOptions): Json {
  const { language, words, mayOmit } = options;
  const text = inLanguage(item.text, language);
  return {
    name: item.key,
    title: isRequired(item) || mayOmit ? text : `${text} (${words.optional})`,
    isRequired: isRequired(item) && !mayOmit,
    requiredErrorText: words.required,
    ...kindOf(item, item.scale ?? instrument.scale ?? null, options),
  };
}

function kindOf(item: Item, scale: Scale | null, { language, words }: FormOptions): Json {
  switch (item.type) {
    case "likert":
      return rating(scale, language);
    case "choice":
      return {
        type: "radiogroup",
        choices: (item.choices ?? []).map((one) => choice(one, language)),
      };
    case "boolean":
      return {
        type: "radiogroup",
        choices: [
          { value: YES, text: words.yes },
          { value: NO, text: words.no },
        ],
      };
    case "integer":
    case "number":
      return number(item, words);
    case "text":
      return isLong(item)
        ? { type: "comment", rows: 4, ...limit(item) }
        : { type: "text", ...limit(item) };
  }
}

const limit = (item: Item): Json => (item.max_length == null ? {} : { maxLength: item.max_length });

const choice = (one: Choice, language: string): Json => ({
  value: one.key,
  text: inLanguage(one.label, language),
});

function stepsOf(scale: Scale | null): readonly number[] {
  const { minimum, maximum, step = 1 } = scale ?? { minimum: 1, maximum: 7 };
  const count = Math.floor((maximum - minimum) / step) + 1;
  return Array.from({ length: count }, (_, index) => minimum + step * index);
}

/** Every step is written out where it has a label of its own; else the ends are. */
function rating(scale: Scale | null, language: string): Json {
  const steps = stepsOf(scale);
  const written = (scale?.labels ?? []).map((label) => inLanguage(label, language));
  const ends =
    written.length === 2 ? { minRateDescription: written[0], maxRateDescription: written[1] } : {};
  return {
    type: "rating",
    displayMode: "buttons",
    rateValues: steps.map((value, index) => ({
      value,
      text: written.length === steps.length ? written[index] : String(value),
    })),
    ...ends,
  };
}

function number(item: Item, words: FormWords): Json {
  const low = item.minimum ?? null;
  const high = item.maximum ?? null;
  return {
    type: "text",
    inputType: "number",
    step: item.type === "integer" ? 1 : 0.1,
    ...(low === null ? {} : { min: low }),
    ...(high === null ? {} : { max: high }),
    description: words.range(low, high, item.unit ?? ""),
    validators:
      item.type === "integer" ? [{ type: "expression", expression: `{${item.key}} % 1 = 0` }] : [],
  };
}

const YES = "yes";
const NO = "no";

type Data = Readonly<Record<string, unknown>>;

/** Every item's answer by its key; what was left out is null, which is not the same as zero. */
export function answersOf(instrument: Instrument, data: Data): Readonly<Record<string, Answer>> {
  return Object.fromEntries(
    instrument.items.map((item) => [item.key, answerOf(item, data[item.key])]),
  );
}

function answerOf(item: Item, value: unknown): Answer {
  if (value === undefined || value === null || value === "") return null;
  if (item.type === "boolean") return value === YES;
  if (item.type === "text" || item.type === "choice") return String(value);
  const parsed = typeof value === "number" ? value : Number(value);
  return Number.isFinite(parsed) ? parsed : null;
}
