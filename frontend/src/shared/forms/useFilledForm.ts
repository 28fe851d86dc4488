/**
 * The state of a form that is being filled in: pages, answers with their times, missing answers.
 */
import { useMemo, useState } from "react";
import type { Administration, Answer } from "../api/types";
import type { FormDraft } from "./draft";
import {
  answer,
  type Filling,
  type Goal,
  pageOf,
  shownProblem,
  showPage,
  startFilling,
  stopAt,
  stopAtAny,
} from "./filling";
import { answersOf, type FormWords, type Question, questionPages } from "./questions";

export interface FilledFormOptions {
  readonly administration: Administration;
  readonly language: string;
  readonly texts: FormWords;
  readonly draft: FormDraft;
  readonly begun?: Filling | undefined;
  readonly startedAt: Date;
  readonly canOmit?: boolean;
  readonly onChange: (draft: FormDraft) => void;
  readonly onSubmit: (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => void;
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
  const [filling, setFilling] = useState(
    () => options.begun ?? startFilling(options.draft, performance.now()),
  );
  // The texts change a moment after the language: one of them serves as a marker of their language.
  // biome-ignore lint/correctness/useExhaustiveDependencies: texts are new at every render
  const pages = useMemo(
    () => questionPages(administration, { language, words: texts, canOmit }),
    [administration.key, language, canOmit, texts.required],
  );
  const { draft } = filling;
  const page = pageOf(filling, pages);

  const update = (next: Filling): void => {
    setFilling(next);
    if (next.draft !== draft) options.onChange(next.draft);
  };
  return {
    questions: pages[page] ?? [],
    page,
    pages: pages.length,
    goal: filling.goal,
    valueOf: ({ key }) => draft.data[key],
    problemOf: (question) => shownProblem(filling, question, texts),
    answer: (question, value) => {
      const sinceStartS = (Date.now() - options.startedAt.getTime()) / 1000;
      update(answer(filling, question, value, { nowMs: performance.now(), sinceStartS }));
    },
    back: () => update(showPage(filling, pages, page - 1, performance.now())),
    next: () => {
      const nowMs = performance.now();
      const stopped = stopAt(filling, pages, page, texts, nowMs);
      update(stopped ?? showPage(filling, pages, page + 1, nowMs));
    },
    submit: () => {
      const stopped = stopAtAny(filling, pages, texts, performance.now());
      if (stopped === null)
        options.onSubmit(answersOf(administration.instrument, draft.data), draft);
      else update(stopped);
    },
  };
}
