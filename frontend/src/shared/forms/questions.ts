/** Convert an instrument to the questions of a form, page by page, and its data to answers. */
import type { Administration, Answer, Instrument, Item, Scale } from "../api/types";
import { inLanguage } from "../text";
import { isLong, pagesOf } from "./pages";

export interface FormWords {
  readonly yes: string;
  readonly no: string;
  readonly optional: string;
  /** The message for a missing answer. */
  readonly required: string;
  /** The message for a number out of range, with `low`, `high` and `unit` filled in. */
  readonly range: (low: number | null, high: number | null, unit: string) => string;
  /** The message for a number that must be whole. */
  readonly whole: string;
  readonly atLeast: (low: number, unit: string) => string;
  readonly atMost: (high: number, unit: string) => string;
}

interface FormOptions {
  readonly language: string;
  readonly words: FormWords;
  /** Whether the operator may omit what the participant did not answer. */
  readonly canOmit: boolean;
  /** Every question on a page of its own, as in a headset; otherwise as many as fit a tablet. */
  readonly isOnePerPage?: boolean;
}

export interface Option {
  readonly value: string | number;
  readonly text: string;
}

interface QuestionBase {
  readonly key: string;
  readonly title: string;
  readonly required: boolean;
}

/** `ends`: the names of the lowest and the highest step, if only they have names. */
export interface Rating extends QuestionBase {
  readonly kind: "rating";
  readonly options: readonly Option[];
  readonly ends: readonly [string, string] | null;
}

export interface Choosing extends QuestionBase {
  readonly kind: "choice";
  readonly options: readonly Option[];
}

export interface NumberField extends QuestionBase {
  readonly kind: "number";
  readonly whole: boolean;
  readonly low: number | null;
  readonly high: number | null;
  readonly unit: string;
  readonly hint: string;
}

export interface TextField extends QuestionBase {
  readonly kind: "text";
  readonly long: boolean;
  readonly most: number | null;
}

export type Question = Rating | Choosing | NumberField | TextField;

/** The questions in the order the server drew, distributed over pages. */
export function questionPages(
  { instrument, item_order }: Administration,
  options: FormOptions,
): readonly (readonly Question[])[] {
  const byKey = new Map(instrument.items.map((item) => [item.key, item]));
  const ordered = item_order.flatMap((key) => byKey.get(key) ?? []);
  const scaleOf = (item: Item) => item.scale ?? instrument.scale ?? null;
  const pages = options.isOnePerPage
    ? ordered.map((item) => [item])
    : pagesOf(ordered, (item) => stepsOf(scaleOf(item)).length);
  return pages.map((items) => items.map((item) => question(item, scaleOf(item), options)));
}

function question(item: Item, scale: Scale | null, options: FormOptions): Question {
  const { language, words, canOmit } = options;
  const text = inLanguage(item.text, language);
  const free = item.required === false;
  const base: QuestionBase = {
    key: item.key,
    // Optional questions are marked in words, since there are few of them.
    title: free && !canOmit ? `${text} (${words.optional})` : text,
    required: !free && !canOmit,
  };
  switch (item.type) {
    case "likert":
      return { ...base, ...rating(scale, language) };
    case "choice":
      return { ...base, kind: "choice", options: choices(item, language) };
    case "boolean":
      return { ...base, kind: "choice", options: yesOrNo(words) };
    case "integer":
    case "number":
      return { ...base, ...numberField(item, words) };
    case "text":
      return { ...base, kind: "text", long: isLong(item), most: item.max_length ?? null };
  }
}

const choices = (item: Item, language: string): readonly Option[] =>
  (item.choices ?? []).map((one) => ({ value: one.key, text: inLanguage(one.label, language) }));

const yesOrNo = (words: FormWords): readonly Option[] => [
  { value: YES, text: words.yes },
  { value: NO, text: words.no },
];

function stepsOf(scale: Scale | null): readonly number[] {
  const { minimum, maximum, step = 1 } = scale ?? { minimum: 1, maximum: 7 };
  const count = Math.floor((maximum - minimum) / step) + 1;
  return Array.from({ length: count }, (_, index) => minimum + step * index);
}

/** Every step is listed if each has its own label; otherwise the ends are named. */
function rating(scale: Scale | null, language: string): Omit<Rating, keyof QuestionBase> {
  const steps = stepsOf(scale);
  const written = (scale?.labels ?? []).map((label) => inLanguage(label, language));
  const [low, high] = written;
  return {
    kind: "rating",
    options: steps.map((value, index) => ({
      value,
      text: (written.length === steps.length ? written[index] : undefined) ?? String(value),
    })),
    ends: written.length === 2 && low !== undefined && high !== undefined ? [low, high] : null,
  };
}

function numberField(item: Item, words: FormWords): Omit<NumberField, keyof QuestionBase> {
  const low = item.minimum ?? null;
  const high = item.maximum ?? null;
  const unit = item.unit ?? "";
  const whole = item.type === "integer";
  return { kind: "number", whole, low, high, unit, hint: words.range(low, high, unit) };
}

const YES = "yes";
const NO = "no";

type Data = Readonly<Record<string, unknown>>;

/** Every item's answer by its key; null for an omitted one, which is not the same as zero. */
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

// Messages about invalid answers, in the participant's language; the server validates all answers
// again.

/** Why the form cannot continue with this value; null if it can. */
export function problemOf(question: Question, value: unknown, words: FormWords): string | null {
  const missing = value === undefined || value === null || String(value).trim() === "";
  if (missing) return question.required ? words.required : null;
  return question.kind === "number" ? numberProblem(question, Number(value), words) : null;
}

function numberProblem(
  { whole, low, high, unit }: NumberField,
  value: number,
  words: FormWords,
): string | null {
  if (Number.isNaN(value)) return words.required;
  if (low !== null && value < low) return words.atLeast(low, unit);
  if (high !== null && value > high) return words.atMost(high, unit);
  return whole && !Number.isInteger(value) ? words.whole : null;
}

/** The first question whose answer is missing or invalid. */
export function firstProblem(
  questions: readonly Question[],
  data: Data,
  words: FormWords,
): Question | undefined {
  return questions.find((question) => problemOf(question, data[question.key], words) !== null);
}
