/**
 * A form that is being filled in, as values: the draft, what is shown as wrong, whose turn it is.
 *
 * Every function returns the form after one thing has happened; tablet, console and headset draw it
 * in their own ways. Times are arguments.
 */
import { answered, type FormDraft, pageShown, type Turn } from "./draft";
import { type FormWords, firstProblem, problemOf, type Question } from "./questions";

/**
 * Where to move the focus now: to the top of the page, or to a question that has to be answered.
 */
export interface Goal {
  /** Null: the top of the page. */
  readonly question: string | null;
}

export interface Filling {
  readonly draft: FormDraft;
  /** Questions whose problems are shown: those of the pages that the participant tried to leave. */
  readonly checked: ReadonlySet<string>;
  /** A new object at every move; null before the first. */
  readonly goal: Goal | null;
  readonly turn: Turn;
}

export type Pages = readonly (readonly Question[])[];

/** When something happened: on a monotonic clock, and in seconds since the form was first shown. */
export interface Moment {
  readonly nowMs: number;
  readonly sinceStartS: number;
}

export const startFilling = (draft: FormDraft, nowMs: number): Filling => ({
  draft,
  checked: new Set(),
  goal: null,
  turn: pageShown(nowMs),
});

/** The page that is shown; a draft may stem from a form with more pages. */
export const pageOf = ({ draft }: Filling, pages: Pages): number =>
  Math.min(draft.page, Math.max(0, pages.length - 1));

/** The form after a question was answered, or its answer taken back (undefined). */
export function answer(
  filling: Filling,
  { key, kind }: Question,
  value: string | number | undefined,
  { nowMs, sinceStartS }: Moment,
): Filling {
  const { draft } = filling;
  const typed = kind === "text" || kind === "number";
  const { traces, turn } = answered(draft.traces, filling.turn, { item: key, typed }, nowMs);
  // The wall clock of a device may be set back while a form is open; no answer comes before it.
  const timings = { ...draft.timings, [key]: Math.max(0, Math.round(sinceStartS * 10) / 10) };
  const data = withAnswer(draft.data, key, value);
  return { ...filling, turn, draft: { ...draft, data, timings, traces } };
}

/** The form on another page, or on the same one with the focus moved. */
export function showPage(
  filling: Filling,
  pages: Pages,
  number: number,
  nowMs: number,
  question: string | null = null,
): Filling {
  const moved = { ...filling, goal: { question } };
  if (number === pageOf(filling, pages)) return moved;
  return { ...moved, turn: pageShown(nowMs), draft: { ...filling.draft, page: number } };
}

/** The form where a page cannot be left yet, with what is wrong shown; null if it can. */
export function stopAt(
  filling: Filling,
  pages: Pages,
  number: number,
  words: FormWords,
  nowMs: number,
): Filling | null {
  const questions = pages[number] ?? [];
  const wrong = firstProblem(questions, filling.draft.data, words);
  if (wrong === undefined) return null;
  const checked = new Set([...filling.checked, ...questions.map(({ key }) => key)]);
  return showPage({ ...filling, checked }, pages, number, nowMs, wrong.key);
}

/** The form on its first page that cannot be left yet; null if all can. */
export function stopAtAny(
  filling: Filling,
  pages: Pages,
  words: FormWords,
  nowMs: number,
): Filling | null {
  for (const number of pages.keys()) {
    const stopped = stopAt(filling, pages, number, words, nowMs);
    if (stopped !== null) return stopped;
  }
  return null;
}

/** What is wrong with an answer, once somebody tried to leave its page. */
export const shownProblem = (
  { checked, draft }: Filling,
  question: Question,
  words: FormWords,
): string | null =>
  checked.has(question.key) ? problemOf(question, draft.data[question.key], words) : null;

/** An answer that was taken back or deleted counts as never answered. */
function withAnswer(
  data: FormDraft["data"],
  key: string,
  value: string | number | undefined,
): FormDraft["data"] {
  const { [key]: _, ...others } = data;
  return value === undefined || value === "" ? others : { ...others, [key]: value };
}
