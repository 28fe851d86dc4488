/** The texts of a form; each family of pages has its own table, with the same keys. */
import type { Translate } from "../i18n/i18n";
import type { FormWords } from "./questions";

export interface FormTexts extends FormWords {
  readonly back: string;
  readonly next: string;
  readonly submit: string;
  readonly page: (number: number, total: number) => string;
}

type FormKey =
  | "form.atLeast"
  | "form.atMost"
  | "form.back"
  | "form.next"
  | "form.no"
  | "form.optional"
  | "form.page"
  | "form.range"
  | "form.required"
  | "form.submit"
  | "form.whole"
  | "form.yes"
  | "unit.years";

export function formTexts(t: Translate<FormKey>): FormTexts {
  // Symbols (cm, kg) are the same in every language; words are not.
  const units: Readonly<Record<string, string>> = { years: t("unit.years") };
  return {
    yes: t("form.yes"),
    no: t("form.no"),
    optional: t("form.optional"),
    required: t("form.required"),
    back: t("form.back"),
    next: t("form.next"),
    submit: t("form.submit"),
    page: (number, total) => t("form.page", { number, total }),
    range: (low, high, unit) =>
      low === null || high === null
        ? (units[unit] ?? unit)
        : t("form.range", { low, high, unit: units[unit] ?? unit }).trim(),
    whole: t("form.whole"),
    atLeast: (low, unit) => t("form.atLeast", { low, unit: units[unit] ?? unit }).trim(),
    atMost: (high, unit) => t("form.atMost", { high, unit: units[unit] ?? unit }).trim(),
  };
}

/** The texts of forms that console and tablet share. */
export const formEn = {
  "unit.years": "years",
  "form.yes": "Yes",
  "form.no": "No",
  "form.optional": "optional",
  "form.required": "Please answer this question.",
  "form.back": "Back",
  "form.next": "Next",
  "form.page": "Page {{number}} of {{total}}",
  "form.range": "{{low}} to {{high}} {{unit}}",
  "form.whole": "Please enter a whole number.",
  "form.atLeast": "At least {{low}} {{unit}}",
  "form.atMost": "At most {{high}} {{unit}}",
} as const;

export const formDe: Record<keyof typeof formEn, string> = {
  "unit.years": "Jahre",
  "form.yes": "Ja",
  "form.no": "Nein",
  "form.optional": "freiwillig",
  "form.required": "Bitte beantworten Sie diese Frage.",
  "form.back": "Zurück",
  "form.next": "Weiter",
  "form.page": "Seite {{number}} von {{total}}",
  "form.range": "{{low}} bis {{high}} {{unit}}",
  "form.whole": "Bitte geben Sie eine ganze Zahl ein.",
  "form.atLeast": "Mindestens {{low}} {{unit}}",
  "form.atMost": "Höchstens {{high}} {{unit}}",
};
