import type { FormTexts } from "@shared/forms/FormView";
import { useTexts } from "../../i18n";

/** The words around a form that the operator fills in. */
export function useFormTexts(): FormTexts {
  const { t } = useTexts();
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
