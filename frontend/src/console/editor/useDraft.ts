/**
 * The state of a study file that is being edited. The text in the field is authoritative: after a
 * change in the form, the server returns the new text, and the difference is put into the field,
 * where it can be undone.
 */
import { redo, undo } from "@codemirror/commands";
import { useDebouncedValue } from "@mantine/hooks";
import { drafts } from "@shared/api/drafts";
import { Unreachable } from "@shared/api/request";
import type { CheckResult } from "@shared/api/types";
import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { type RefObject, useRef, useState } from "react";
import { type Change, type Path, pathText } from "./paths";
import { replaceText, showLine, type YamlText } from "./YamlField";

const PAUSE_MS = 350;
/** How long after a server that did not respond the request is sent again. */
const AGAIN_MS = 2000;
const NO_PROBLEMS: CheckResult["problems"] = [];

export interface Draft {
  readonly text: string;
  readonly field: RefObject<YamlText | null>;
  readonly onText: (text: string, byForm: boolean) => void;
  /** The check of the newest text that was checked; undefined before the first answer. */
  readonly check: CheckResult | undefined;
  readonly problems: CheckResult["problems"];
  /** Whether the check is of the current text. */
  readonly upToDate: boolean;
  readonly error: unknown;
  readonly change: (changes: readonly Change[]) => void;
  readonly reveal: (path: Path) => void;
  readonly goTo: (line: number) => void;
  readonly undo: () => void;
  readonly redo: () => void;
}

export function useDraft(initial: string): Draft {
  const [text, setText] = useState(initial);
  const [byForm, setByForm] = useState(false);
  const [settled] = useDebouncedValue(text, PAUSE_MS);
  const [failure, setFailure] = useState<unknown>(null);
  const field = useRef<YamlText | null>(null);
  const queue = useRef(Promise.resolve());
  const checked = byForm ? text : settled;
  const query = useQuery({
    queryKey: ["check", checked],
    queryFn: () => drafts.check(checked),
    placeholderData: keepPreviousData,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 30_000,
    refetchInterval: ({ state }) => (state.error instanceof Unreachable ? AGAIN_MS : false),
  });
  const upToDate = checked === text && !query.isPlaceholderData && query.data !== undefined;
  const change = (changes: readonly Change[]) => {
    queue.current = queue.current.then(async () => {
      // Without a connection the field in the form keeps what was entered, and so does this.
      while (field.current !== null) {
        try {
          await apply(field, changes);
          return setFailure(null);
        } catch (error) {
          setFailure(error);
          if (!(error instanceof Unreachable)) return;
          await new Promise((goOn) => setTimeout(goOn, AGAIN_MS));
        }
      }
    });
  };
  const problems = query.data?.problems ?? NO_PROBLEMS;
  return {
    text,
    field,
    onText: (next, fromForm) => {
      setText(next);
      setByForm(fromForm);
    },
    check: query.data,
    problems,
    upToDate,
    error: failure ?? query.error,
    change,
    reveal: (path) => {
      const line = query.data?.lines?.[pathText(path)];
      if (line !== undefined && field.current !== null) showLine(field.current.view, line, false);
    },
    goTo: (line) => field.current !== null && showLine(field.current.view, line, true),
    undo: () => field.current !== null && undo(field.current.view),
    redo: () => field.current !== null && redo(field.current.view),
  };
}

/**
 * If somebody continues to type while the server answers, the change is requested again on the
 * newer text.
 */
async function apply(field: RefObject<YamlText | null>, changes: readonly Change[]): Promise<void> {
  for (let attempt = 0; attempt < 5; attempt += 1) {
    const view = field.current?.view;
    if (view === undefined) return;
    const before = view.state.doc.toString();
    const { yaml } = await drafts.edit(before, changes);
    if (view.state.doc.toString() === before) {
      replaceText(view, yaml);
      return;
    }
  }
}
