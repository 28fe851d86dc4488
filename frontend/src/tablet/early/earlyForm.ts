/** The form that is filled in before the application is there, until the application has it. */
import type { FormDraft } from "@shared/forms/draft";
import { answer, type Filling } from "@shared/forms/filling";
import type { Question } from "@shared/forms/questions";
import { formId, type StoredForm } from "@shared/forms/storedForms";

export interface EarlyForm {
  /** As it is stored, with what was answered so far. */
  readonly form: StoredForm;
  readonly filling: Filling;
  /** What is asked on its page: only questions with options. */
  readonly questions: readonly Question[];
}

let current: EarlyForm | null = null;

export const currentForm = (): EarlyForm | null => current;

/** The early form if it is this one. */
export const earlyForm = (sessionId: string, administration: string): EarlyForm | null =>
  current?.form.id === formId(sessionId, administration) ? current : null;

export function keepEarlyForm(form: EarlyForm): void {
  current = form;
}

export function forgetEarlyForm(): void {
  current = null;
}

/** Answer a question with the option of this value; `null` takes the answer back. */
export function choose(
  early: EarlyForm,
  key: string,
  written: string | null,
  now: Date,
): EarlyForm {
  const question = early.questions.find((one) => one.key === key);
  if (question === undefined || !("options" in question)) return early;
  const option = question.options.find(({ value }) => String(value) === written);
  const sinceStartS = (now.getTime() - Date.parse(early.form.startedAt)) / 1000;
  const moment = { nowMs: performance.now(), sinceStartS };
  const filling = answer(early.filling, question, option?.value, moment);
  return { ...early, filling, form: { ...early.form, draft: filling.draft } };
}

/** Whether pressing the option of this value takes the answer back. */
export function takesBack(
  { filling, questions }: EarlyForm,
  key: string,
  written: string,
): boolean {
  const isOptional = questions.some((one) => one.key === key && !one.required);
  return isOptional && String(filling.draft.data[key]) === written;
}

export const isUntouched = ({ data, page }: FormDraft): boolean =>
  page === 0 && Object.keys(data).length === 0;

/** A stored form, with the answers that another record of it has got since. */
export function joined(stored: StoredForm, newer: StoredForm): StoredForm {
  const [before, since] = [stored.draft, newer.draft];
  // The times of answers count from when the form was first shown.
  const laterS = (Date.parse(newer.startedAt) - Date.parse(stored.startedAt)) / 1000;
  const timings = Object.entries(since.timings).map(([key, s]) => [key, s + laterS] as const);
  const draft = {
    page: before.page,
    data: { ...before.data, ...since.data },
    timings: { ...before.timings, ...Object.fromEntries(timings) },
    traces: { ...before.traces, ...since.traces },
  };
  return { ...stored, draft };
}

/** The early form as a continuation of what is stored of it, which looks the same. */
export function continued(early: EarlyForm, stored: StoredForm): EarlyForm {
  const form = joined(stored, early.form);
  return { ...early, form, filling: { ...early.filling, draft: form.draft } };
}
