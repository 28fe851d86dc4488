import { useEffect } from "react";
import type { Work } from "./useWork";

/** What lies above the page and has keys of its own. */
const ABOVE = '[role="dialog"][aria-modal="true"], [role="menu"]';

/**
 * Ctrl+Z, Ctrl+Shift+Z or Ctrl+Y, and Ctrl+S: not in fields, which have their own, and not behind
 * an open dialog or menu.
 */
export function useKeys(work: Work, isReadOnly: boolean, save: () => void): void {
  useEffect(() => {
    if (isReadOnly) return;
    const onKey = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey)) return;
      const key = event.key.toLowerCase();
      const isField =
        event.target instanceof HTMLElement &&
        event.target.matches(
          "input:not([type=range]):not([type=radio]):not([type=checkbox]), textarea",
        );
      const isBehind = document.querySelector(ABOVE) !== null;
      if (key === "s" && !isBehind) save();
      else if (key === "s") {
        // The browser would save the page.
      } else if (isField || isBehind) return;
      else if (key === "y" || (key === "z" && event.shiftKey)) work.redo();
      else if (key === "z") work.undo();
      else return;
      event.preventDefault();
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  });
}
