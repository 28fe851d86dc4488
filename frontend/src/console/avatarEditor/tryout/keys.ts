/** Keys of the try-out, and when they are its own. */
import { type RefObject, useEffect, useRef } from "react";
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
 * Listen while the try-out is on the page. A key is its own when the focus is in it, or nowhere: then
 * the space bar plays and pauses instead of scrolling the page.
 */
export function useKeys(
  root: RefObject<HTMLElement | null>,
  to: { readonly [Key in keyof Keyed]: Keyed[Key] | null },
): void {
  const latest = useRef(to);
  latest.current = to;
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const { run, scene, commands, onFollow } = latest.current;
      const act = KEYS[event.key.toLowerCase()];
      if (act === undefined || run === null || commands === null || onFollow === null) return;
      if (event.defaultPrevented || !isOwn(event, root.current)) return;
      event.preventDefault();
      act({ run, scene, commands, onFollow });
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, [root]);
}

/** Elements in which a key already has a meaning. */
const TYPED = "input:not([type='radio'], [type='checkbox']), textarea, [role='combobox']";

function isOwn(event: KeyboardEvent, root: HTMLElement | null): boolean {
  const { target } = event;
  if (event.ctrlKey || event.metaKey || event.altKey || !(target instanceof Element)) return false;
  if (target !== document.body && root?.contains(target) !== true) return false;
  return target.closest(event.key === " " ? `button, input, ${TYPED}` : TYPED) === null;
}
