/**
 * The context shared by all fields of the form: the file's values, its problems, and a way to
 * change it.
 */
import type { ConfigProblem } from "@shared/api/types";
import { registryEn } from "@shared/session/registries.generated";
import { createContext, useContext, useEffect, useRef, useState } from "react";
import { type Key, useTexts } from "../i18n";
import { preregistrationEn } from "../preregistration/texts";
import { fieldsEn } from "./fields/texts";
import type { KnownOfStudy } from "./firstPreregistration";
import { type Change, type JsonObject, type Path, pathText, valueAt } from "./paths";

export interface FormState {
  readonly tree: JsonObject;
  readonly languages: readonly string[];
  readonly instruments: readonly string[];
  readonly known: KnownOfStudy;
  readonly problems: readonly ConfigProblem[];
  readonly change: (changes: readonly Change[]) => void;
  /** Show the position in the text. */
  readonly reveal: (path: Path) => void;
}

export const FormContext = createContext<FormState | null>(null);

export function useForm(): FormState {
  const state = useContext(FormContext);
  if (state === null) throw new Error("A field is outside of the form.");
  return state;
}

/** The problems at exactly this path, joined into one text; null if there are none. */
export function useProblem(path: Path): string | null {
  const { problems } = useForm();
  const own = pathText(path);
  const found = problems.filter((problem) => problem.path === own);
  return found.length === 0
    ? null
    : found.map(({ message, remedy }) => `${message} ${remedy ?? ""}`.trim()).join(" ");
}

export const useValue = (path: Path) => valueAt(useForm().tree, path);

/** The names of fields and their values: in the reader's language if there is a text for them. */
const NAMED: Readonly<Record<string, string>> = {
  ...fieldsEn,
  ...preregistrationEn,
  ...registryEn,
};
const UNITS: Readonly<Record<string, string>> = { s: "s", ms: "ms", m: "m", cm: "cm", deg: "°" };

/**
 * Make a setting's name readable: `freeze_s` becomes `Freeze (s)`, if it is newer than the tables
 * of texts.
 */
function readable(name: string): string {
  const parts = name.split("_");
  const unit = parts.length > 1 ? UNITS[parts.at(-1) ?? ""] : undefined;
  const words = (unit === undefined ? parts : parts.slice(0, -1)).join(" ");
  const written = words.charAt(0).toUpperCase() + words.slice(1);
  return unit === undefined ? written : `${written} (${unit})`;
}

/** The key of the text of a field in one particular object, such as `field.valid_when.forms`. */
export const fieldKey = (name: string, of: Path): string => `field.${[...of, name].join(".")}`;

interface Labels {
  /** `of`: the path of the object that has the field, where the same name means another thing. */
  readonly field: (name: string, of?: Path) => string;
  readonly hint: (name: string) => string | undefined;
  readonly value: (value: string) => string;
}

export function useLabels(): Labels {
  const { t } = useTexts();
  const translated = (key: string): string | undefined =>
    key in NAMED ? t(key as Key) : undefined;
  return {
    field: (name, of = []) =>
      translated(fieldKey(name, of)) ?? translated(`field.${name}`) ?? readable(name),
    hint: (name) => translated(`hint.${name}`),
    value: (value) => translated(`value.${value}`) ?? translated(`step.${value}`) ?? value,
  };
}

const PAUSE_MS = 700;

/** A text field that reports its content when the writer pauses or leaves it, not at every key. */
export function useCommitted(value: string, commit: (value: string) => void) {
  const [local, setLocal] = useState(value);
  const pending = useRef<string | null>(null);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const latest = useRef(commit);
  useEffect(() => {
    latest.current = commit;
  });
  // What is being typed stays; otherwise the field follows the file.
  useEffect(() => {
    if (pending.current === null || pending.current === value) {
      pending.current = null;
      setLocal(value);
    }
  }, [value]);
  const flush = () => {
    clearTimeout(timer.current);
    if (pending.current !== null && pending.current !== value) latest.current(pending.current);
    pending.current = null;
  };
  const flushLater = useRef(flush);
  useEffect(() => {
    flushLater.current = flush;
  });
  useEffect(() => () => clearTimeout(timer.current), []);
  return {
    value: local,
    onChange: (text: string) => {
      setLocal(text);
      pending.current = text;
      clearTimeout(timer.current);
      timer.current = setTimeout(() => flushLater.current(), PAUSE_MS);
    },
    onBlur: flush,
  };
}
