/** What every field of the form shares: the file's values, its problems, and a way to change it. */
import type { ConfigProblem } from "@shared/api/types";
import { createContext, useContext } from "react";
import type { Change, JsonObject, Path } from "./paths";
import { pathText, valueAt } from "./paths";

export interface FormState {
  readonly tree: JsonObject;
  readonly languages: readonly string[];
  readonly instruments: readonly string[];
  readonly problems: readonly ConfigProblem[];
  readonly change: (changes: readonly Change[]) => void;
  /** Show the place in the text. */
  readonly reveal: (path: Path) => void;
}

export const FormContext = createContext<FormState | null>(null);

export function useForm(): FormState {
  const state = useContext(FormContext);
  if (state === null) throw new Error("A field is outside of the form.");
  return state;
}

/** What is wrong at just this place, in one text; null if nothing is. */
export function useProblem(path: Path): string | null {
  const { problems } = useForm();
  const own = pathText(path);
  const found = problems.filter((problem) => problem.path === own);
  return found.length === 0
    ? null
    : found.map(({ message, remedy }) => `${message} ${remedy ?? ""}`.trim()).join(" ");
}

export const useValue = (path: Path) => valueAt(useForm().tree, path);
