/** The screens of a form: its beginning, one question at a time, and the answers to check. */
import type { Administration, Submission } from "@shared/api/types";
import type { FormDraft } from "@shared/forms/draft";
import type { Choosing, NumberField, Question } from "@shared/forms/questions";
import { inLanguage } from "@shared/text";
import type { Choice, Choices, PanelButton, PanelScreen } from "../surface/screen";
import type { PanelWords } from "../texts";

/** Values of an open question in a headset: answered aloud, or nothing to say. */
export const SPOKEN = "spoken";
export const NOTHING = "nothing";

/** Whether something in a form was said aloud, which somebody has to write down. */
export const hasSpoken = (draft: FormDraft, submission: Submission): boolean =>
  Object.entries(draft.data).some(
    ([item, value]) => value === SPOKEN && submission.answers[item] === null,
  );

export interface Shown {
  readonly administration: Administration;
  readonly language: string;
  readonly words: PanelWords;
}

/**
 * The questions as a headset asks them: nobody can type in it, so an open question asks whether the
 * participant will answer it aloud. An optional one can be left out.
 */
export const asAsked =
  (words: PanelWords) =>
  (question: Question): Question => {
    if (question.kind !== "text") return question;
    const spoken = { value: SPOKEN, text: words("form.spoken") };
    const nothing = { value: NOTHING, text: words("form.nothing") };
    const { key, title, required } = question;
    const options = required ? [spoken] : [spoken, nothing];
    return { kind: "choice", key, title, required, options } satisfies Choosing;
  };

/** The first screen: what the form is about, and how to answer. */
export function introScreen({ administration, language, words }: Shown): PanelScreen {
  const { instrument, item_order } = administration;
  const instructions = inLanguage(instrument.instructions, language);
  const texts = [
    instructions,
    words("form.intro", { count: item_order.length }),
    words("form.how"),
  ];
  return {
    key: `${administration.key} intro`,
    title: inLanguage(instrument.title, language),
    body: texts.filter((text) => text !== "").map((text) => ({ kind: "prose", text })),
    buttons: [{ target: "start", text: words("form.start"), side: "right", isPrimary: true }],
  };
}

interface AskedQuestion extends Shown {
  readonly question: Question;
  readonly value: unknown;
  readonly problem: string | null;
  readonly number: number;
  readonly total: number;
  /** Whether it is changed after all were answered. */
  readonly isReviewed: boolean;
}

export function questionScreen(asked: AskedQuestion): PanelScreen {
  const { administration, language, words, question, number, total } = asked;
  const stem = inLanguage(administration.instrument.stem, language);
  const item = administration.instrument.items.find(({ key }) => key === question.key);
  const lead = item?.type === "text" ? words("form.spoken.lead") : stem;
  const toReview = asked.isReviewed || number === total;
  const back: readonly PanelButton[] =
    number === 1 || asked.isReviewed
      ? []
      : [{ target: "back", text: words("form.back"), side: "left" }];
  return {
    key: `${administration.key} ${question.key}`,
    ...(lead === "" ? {} : { lead }),
    title: question.title,
    isQuestion: true,
    choices: choicesOf(question, asked.value, words),
    problem: asked.problem,
    progress: { done: number, of: total, text: words("form.question", { number, total }) },
    buttons: [
      ...back,
      {
        target: "next",
        text: words(toReview ? "form.review" : "form.next"),
        side: "right",
        isPrimary: true,
      },
    ],
  };
}

export const answerTarget = (value: string | number): string => `answer ${value}`;

function choicesOf(question: Question, value: unknown, words: PanelWords): Choices {
  if (question.kind === "number") return keypad(question, value, words);
  if (question.kind === "text") return { layout: "rows", items: [] };
  const isNumbered =
    question.kind === "rating" &&
    question.options.some(({ text, value: at }) => text !== String(at));
  const items = question.options.map(
    ({ value: at, text }): Choice => ({
      target: answerTarget(at),
      text,
      isChosen: value === at,
      ...(isNumbered ? { badge: String(at) } : {}),
    }),
  );
  const ends = question.kind === "rating" ? question.ends : null;
  // Names are read in full, however many there are: the panel grows with them.
  const isShort = question.kind === "rating" && !isNumbered;
  return isShort ? { layout: "steps", items, ends } : { layout: "rows", items };
}

/** As many as fit the field of the entry. */
const MOST_SIGNS = 12;
const SIGNS = ["1", "2", "3", "4", "5", "6", "7", "8", "9"] as const;

function keypad(question: NumberField, value: unknown, words: PanelWords): Choices {
  const key = (sign: string): Choice => ({ target: `key ${sign}`, text: sign });
  const decimal = words("decimal");
  const entry = value === undefined || value === null ? "" : String(value).replace(".", decimal);
  const hasNegatives = question.low === null || question.low < 0;
  const items = [
    ...SIGNS.map(key),
    question.whole ? { target: "key clear", text: "C" } : { target: "key .", text: decimal },
    key("0"),
    { target: "key delete", text: words("form.delete") },
    ...(hasNegatives ? [{ target: "key minus", text: "±" }] : []),
  ];
  const shown = entry === "" ? "" : `${entry} ${question.unit}`.trim();
  return { layout: "keys", items, entry: shown, hint: question.hint };
}

/** What a digit's key makes of the number entered so far. */
export function typed(value: unknown, key: string): string | undefined {
  const before = value === undefined || value === null ? "" : String(value);
  if (key === "clear") return undefined;
  if (key === "delete") return before.length <= 1 ? undefined : before.slice(0, -1);
  if (key === "minus") return before.startsWith("-") ? before.slice(1) || undefined : `-${before}`;
  if (key === "." && before.includes(".")) return before;
  if (before.length >= MOST_SIGNS) return before;
  return key === "." && /^-?$/.test(before) ? `${before}0.` : before + key;
}

/** How an answer reads in the list of answers. */
export function answerText(question: Question, value: unknown, words: PanelWords): string {
  if (value === undefined || value === null || value === "") return words("form.unanswered");
  if (question.kind === "number") {
    return `${String(value).replace(".", words("decimal"))} ${question.unit}`.trim();
  }
  if (question.kind === "text") return String(value);
  const option = question.options.find((one) => one.value === value);
  if (option === undefined) return String(value);
  const isNumbered = question.kind === "rating" && option.text !== String(option.value);
  return isNumbered ? `${option.value} ${option.text}` : option.text;
}

/** So many answers are listed at a time. */
export const REVIEW_ROWS = 5;

interface Review extends Shown {
  readonly questions: readonly Question[];
  readonly data: Readonly<Record<string, unknown>>;
  readonly page: number;
}

/** The list of answers before they are sent. */
export function reviewScreen(review: Review): PanelScreen {
  const { administration, words, questions, data, page } = review;
  const pages = Math.max(1, Math.ceil(questions.length / REVIEW_ROWS));
  const listed = questions.slice(page * REVIEW_ROWS, (page + 1) * REVIEW_ROWS);
  const items = listed.map(
    (question, at): Choice => ({
      target: `review ${page * REVIEW_ROWS + at}`,
      badge: String(page * REVIEW_ROWS + at + 1),
      text: question.title,
      maxLines: 2,
      detail: answerText(question, data[question.key], words),
    }),
  );
  const isLast = page >= pages - 1;
  return {
    key: `${administration.key} review ${page}`,
    lead: words("form.review.body"),
    title: words("form.review.title"),
    choices: { layout: "rows", items },
    progress: {
      done: page + 1,
      of: pages,
      text: words("form.review.page", { page: page + 1, pages }),
    },
    buttons: [
      { target: "back", text: words("form.back"), side: "left" },
      isLast
        ? { target: "submit", text: words("form.submit"), side: "right", isPrimary: true }
        : { target: "more", text: words("form.review.more"), side: "right", isPrimary: true },
    ],
  };
}
