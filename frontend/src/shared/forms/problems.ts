/** What is wrong with an answer, in the participant's words; the server looks again at all of them. */
import type { Data, FormWords, NumberField, Question } from "./questions";

/** Why the form cannot go on with this value; null where it can. */
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

/** The first question of those that cannot go on. */
export function firstProblem(
  questions: readonly Question[],
  data: Data,
  words: FormWords,
): Question | undefined {
  return questions.find((question) => problemOf(question, data[question.key], words) !== null);
}
