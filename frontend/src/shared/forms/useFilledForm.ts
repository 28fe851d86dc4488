/**
 * The state of a form that is being filled in: pages, answers with their times, missing answers.
 */
import { useMemo, useRef, useState } from "react";
import type { Administration, Answer } from "../api/types";
import { answered, type FormDraft, pageShown } from "./draft";
import {
  answersOf,
  type FormWords,
  firstProblem,
  problemOf,
  type Question,
  questionPages,
} from "./questions";

export interface FilledFormOptions {
  readonly administration: Administration;
  readonly language: string;
  readonly texts: FormWords;
  readonly draft: FormDraft;
  readonly startedAt: Date;
  readonly canOmit?: boolean;
  readonly onChange: (draft: FormDraft) => void;
  readonly onSubmit: (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => void;
}

/**
 * Where to move the focus now: to the top of the page, or to a question that has to be answered.
 */
export interface Goal {
  /** Null: the top of the page. */
  readonly question: string | null;
}

export interface FilledForm {
  readonly questions: readonly Question[];
  readonly page: number;
  readonly pages: number;
  /** A new object at every move; null before the first. */
  readonly goal: Goal | null;
  readonly valueOf: (question: Question) => unknown;
  readonly problemOf: (question: Question) => string | null;
  readonly answer: (question: Question, value: string | number | undefined) => void;
  readonly back: () => void;
  readonly next: () => void;
  readonly submit: () => void;
}

export function useFilledForm(options: FilledFormOptions): FilledForm {
  const { administration, language, texts, canOmit = false } = options;
  const [draft, setDraft] = useState(options.draft);
  // Questions whose problems are shown: those of the pages that the participant tried to leave.
  const [checked, setChecked] = useState<ReadonlySet<string>>(new Set());
  const [goal, setGoal] = useState<Goal | null>(null);
  const turn = useRef(pageShown(performance.now()));
  // The texts change a moment after the language: one of them serves as a marker of their language.
  // biome-ignore lint/correctness/useExhaustiveDependencies: texts are new at every render
  const pages = useMemo(
    () => questionPages(administration, { language, words: texts, canOmit }),
    [administration.key, language, canOmit, texts.required],
  );
  const page = Math.min(draft.page, Math.max(0, pages.length - 1));
  const questions = pages[page] ?? [];

  const update = (changed: Partial<FormDraft>): void => {
    const next = { ...draft, ...changed };
    setDraft(next);
    options.onChange(next);
  };
  const show = (number: number, question: string | null = null): void => {
    setGoal({ question });
    if (number === page) return;
    turn.current = pageShown(performance.now());
    update({ page: number });
  };
  /** Show what is wrong on a page, if anything is, and go there. */
  const stays = (number: number): boolean => {
    const questionsOf = pages[number] ?? [];
    const wrong = firstProblem(questionsOf, draft.data, texts);
    if (wrong === undefined) return false;
    setChecked(new Set([...checked, ...questionsOf.map(({ key }) => key)]));
    show(number, wrong.key);
    return true;
  };
  return {
    questions,
    page,
    pages: pages.length,
    goal,
    valueOf: ({ key }) => draft.data[key],
    problemOf: (question) =>
      checked.has(question.key) ? problemOf(question, draft.data[question.key], texts) : null,
    answer: ({ key, kind }, value) => {
      const typed = kind === "text" || kind === "number";
      const now = performance.now();
      const noted = answered(draft.traces, turn.current, { item: key, typed }, now);
      turn.current = noted.turn;
      const elapsed = (Date.now() - options.startedAt.getTime()) / 1000;
      const timings = { ...draft.timings, [key]: Math.round(elapsed * 10) / 10 };
      update({ data: withAnswer(draft.data, key, value), timings, traces: noted.traces });
    },
    back: () => show(page - 1),
    next: () => {
      if (!stays(page)) show(page + 1);
    },
    submit: () => {
      if (!pages.some((_, number) => stays(number)))
        options.onSubmit(answersOf(administration.instrument, draft.data), draft);
    },
  };
}

/** An answer that was taken back or deleted counts as never answered. */
function withAnswer(
  data: FormDraft["data"],
  key: string,
  value: string | number | undefined,
): FormDraft["data"] {
  const { [key]: _, ...others } = data;
  return value === undefined || value === "" ? others : { ...others, [key]: value };
}
