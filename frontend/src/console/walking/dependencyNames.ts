/** What a walk depends on, by its name, value and unit. */
import { number } from "@shared/format";
import { type Key, useTexts } from "../i18n";
import { namedNumber, numberLabel } from "./furtherNumbers";

const KNOWN = ["length_m", "turning_per_m", "stature_m"] as const;

/** A dependency with its value, such as `length 2.4 m` or `load 8 kg`. */
export function useDependency(): (name: string, value: number) => string {
  const { t, language } = useTexts();
  return (name, value) => {
    if (isKnown(name)) {
      return t(`walking.dependency.${name}`, { value: number(value, language) });
    }
    const { words, unit } = namedNumber(name);
    return [words, number(value, language), unit ?? []].flat().join(" ");
  };
}

/** The name of a dependency in a sentence, such as `stature` or `load`. */
export function useDependencyWord(): (name: string) => string {
  const { t } = useTexts();
  return (name) => (isKnown(name) ? t(`walking.word.${name}`) : namedNumber(name).words);
}

/** The name of a dependency with its unit, such as `Length (m)` or `Load (kg)`. */
export function useDependencyLabel(): (name: string) => string {
  const { t } = useTexts();
  return (name) => (isKnown(name) ? t(`walking.fact.${name}`) : numberLabel(name));
}

export function useParameter(): (name: string, unit: string) => string {
  const { t } = useTexts();
  return (name, unit) =>
    ["velocity", "acceleration", "angular"].includes(name)
      ? t(`walking.parameter.${name}` as Key)
      : `${name} (${unit})`;
}

const isKnown = (name: string): name is (typeof KNOWN)[number] =>
  KNOWN.some((dependency) => dependency === name);
