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
