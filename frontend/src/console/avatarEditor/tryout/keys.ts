/** Keys of the try-out, and when they are its own. */
import { useEffect, useRef } from "react";
import type { TryoutRun } from "./run";
import type { TryoutScene } from "./scene";
import type { Commands } from "./useCommands";

interface Keyed {
  readonly run: TryoutRun;
  readonly scene: TryoutScene | null;
  readonly commands: Commands;
  readonly onFollow: () => void;
}

export const KEYS: Readonly<Record<string, (to: Keyed) => void>> = {
  " ": ({ run }) => run.play(!run.state.isPlaying),
  ".": ({ run }) => run.step(),
  r: ({ run }) => run.send({ kind: "reset" }),
  p: ({ commands }) => commands.disturbance.go(),
  b: ({ commands }) => commands.disturbance.drop(),
  v: ({ scene }) => scene?.resetCamera(),
  f: ({ onFollow }) => onFollow(),
};

/**
 * Listen while the try-out is on the page: wherever the focus is, except where a key has a meaning
 * already, and not behind a dialog. The space bar plays and pauses instead of scrolling the page.
 */
export function useKeys(to: { readonly [Key in keyof Keyed]: Keyed[Key] | null }): void {
  const latest = useRef(to);
  latest.current = to;
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const { run, scene, commands, onFollow } = latest.current;
      const act = KEYS[event.key.toLowerCase()];
      if (act === undefined || run === null || commands === null || onFollow === null) return;
      if (event.defaultPrevented || !isOwn(event)) return;
      event.preventDefault();
      act({ run, scene, commands, onFollow });
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, []);
}

/** Elements in which a key already has a meaning. */
const TYPED =
  "input:not([type='radio'], [type='checkbox']), textarea, select, [contenteditable='true'], [role='combobox'], [role='option'], [role='menu']";
/** What the space bar presses; the tab that is shown already has nothing to be pressed for. */
const PRESSED = "button, input, a[href], summary";
const SHOWN_TAB = "[role='tab'][aria-selected='true']";
const DIALOG = "[role='dialog'][aria-modal='true']";

export function isOwn({
  key,
  target,
  ctrlKey,
  metaKey,
  altKey,
}: Pick<KeyboardEvent, "key" | "target" | "ctrlKey" | "metaKey" | "altKey">): boolean {
  if (ctrlKey || metaKey || altKey || !(target instanceof Element)) return false;
  if (document.querySelector(DIALOG) !== null || target.closest(TYPED) !== null) return false;
  return key !== " " || target.matches(SHOWN_TAB) || target.closest(PRESSED) === null;
}
