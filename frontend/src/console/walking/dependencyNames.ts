/** What a walk depends on, by its name, value and unit. */
import { number } from "@shared/format";
import { type Key, useTexts } from "../i18n";

const KNOWN = ["length_m", "turning_per_m", "stature_m"] as const;

export function useDependency(): (name: string, value: number) => string {
  const { t, language } = useTexts();
  return (name, value) =>
    isKnown(name)
      ? t(`walking.dependency.${name}`, { value: number(value, language) })
      : `${name} ${number(value, language)}`;
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
