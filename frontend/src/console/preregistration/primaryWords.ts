/** A primary test in words, with the names that study and instrument give what it refers to. */
import type { components } from "@shared/api/schema";
import { inLanguage } from "@shared/text";
import type { useTexts } from "../i18n";

type Texts = Pick<ReturnType<typeof useTexts>, "t" | "language">;
export type PrimaryTest = components["schemas"]["PrimaryTest"];
export type PrimaryNames = components["schemas"]["PrimaryNames"];

const named = (
  name: Readonly<Record<string, string>> | null,
  key: string | null | undefined,
  language: string,
): string => inLanguage(name, language) || (key ?? "");

/** What the test measures, such as a score of a questionnaire. */
export const measureWords = (
  { t, language }: Texts,
  primary: PrimaryTest,
  names: PrimaryNames,
): string =>
  primary.measure === "score"
    ? t("prereg.words.score", {
        score: named(names.score, primary.score, language),
        instrument: named(names.instrument, primary.instrument, language),
      })
    : t(`value.${primary.measure}`);

/** Test, measure, limb, direction, reference and correction, as sentences. */
export function primaryWords(texts: Texts, primary: PrimaryTest, names: PrimaryNames): string {
  const { t, language } = texts;
  const test = t("prereg.words", {
    test: t(`value.${primary.test}`),
    measure: measureWords(texts, primary, names),
    limb: primary.limb === "both" ? t("value.both") : t(`prereg.words.${primary.limb}`),
    direction: t(`value.${primary.direction ?? "two_sided"}`),
  });
  const reference = named(names.reference, primary.reference, language);
  return [
    test,
    reference === "" ? "" : t("prereg.words.reference", { reference }),
    primary.correction === "holm" ? t("prereg.words.holm") : "",
  ]
    .filter((sentence) => sentence !== "")
    .join(" ");
}
