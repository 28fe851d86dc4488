/** What fields and their values are called: in the reader's language where we have a word for them. */
import { type Key, useTexts } from "../i18n";
import { fieldsEn } from "../i18n/fieldTexts";
import { preregistrationEn } from "../i18n/preregistrationTexts";

const NAMED: Readonly<Record<string, string>> = { ...fieldsEn, ...preregistrationEn };
const UNITS: Readonly<Record<string, string>> = { s: "s", ms: "ms", m: "m", cm: "cm", deg: "°" };

/** `freeze_s` as `Freeze (s)`: for a setting that is newer than the tables of words. */
export function readable(name: string): string {
  const parts = name.split("_");
  const unit = parts.length > 1 ? UNITS[parts.at(-1) ?? ""] : undefined;
  const words = (unit === undefined ? parts : parts.slice(0, -1)).join(" ");
  const written = words.charAt(0).toUpperCase() + words.slice(1);
  return unit === undefined ? written : `${written} (${unit})`;
}

export interface Labels {
  readonly field: (name: string) => string;
  readonly hint: (name: string) => string | undefined;
  readonly value: (value: string) => string;
}

export function useLabels(): Labels {
  const { t } = useTexts();
  const known = (key: string): string | undefined => (key in NAMED ? t(key as Key) : undefined);
  return {
    field: (name) => known(`field.${name}`) ?? readable(name),
    hint: (name) => known(`hint.${name}`),
    value: (value) => known(`value.${value}`) ?? value,
  };
}
