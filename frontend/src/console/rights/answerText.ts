/** An answer in the words that the participant chose. */
import type { AnswerValue, Form } from "@shared/api/rights";
import type { Item, Scale } from "@shared/api/types";
import { inLanguage } from "@shared/text";

export interface AnswerWords {
  readonly leftOut: string;
  readonly yes: string;
  readonly no: string;
}

export function answerText(
  form: Form,
  item: Item,
  value: AnswerValue,
  language: string,
  words: AnswerWords,
): string {
  if (value === null) return words.leftOut;
  switch (item.type) {
    case "boolean":
      return value === true || value === 1 ? words.yes : words.no;
    case "choice": {
      const choice = item.choices?.find(({ key }) => key === value);
      return choice === undefined ? String(value) : inLanguage(choice.label, language);
    }
    case "likert": {
      const label = labelAt(scaleOf(form, item), Number(value), language);
      return label === null ? String(value) : `${value} (${label})`;
    }
    default:
      return item.unit ? `${value} ${item.unit}` : String(value);
  }
}

export const scaleOf = (form: Form, item: Item): Scale | null =>
  item.scale ?? form.definition.scale ?? null;

export function stepsOf({ minimum, maximum, step = 1 }: Scale): readonly number[] {
  const count = Math.floor((maximum - minimum) / step) + 1;
  return Array.from({ length: count }, (_, index) => minimum + step * index);
}

/** The label of this step of the scale, if every step or this end has one. */
export function labelAt(scale: Scale | null, value: number, language: string): string | null {
  if (scale === null || scale.labels.length === 0) return null;
  const steps = stepsOf(scale);
  const at = steps.indexOf(value);
  const label =
    scale.labels.length === steps.length
      ? scale.labels[at]
      : at === 0
        ? scale.labels[0]
        : at === steps.length - 1
          ? scale.labels.at(-1)
          : undefined;
  return label === undefined ? null : inLanguage(label, language);
}
