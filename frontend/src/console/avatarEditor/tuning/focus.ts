/** Keep the focus in a place whose pressed button disappears or is switched off by its own press. */
import { type RefObject, useEffect, useRef } from "react";

/**
 * Give the focus to the first of some places that is there, when the element inside of `around`
 * that had it is gone or disabled, and the browser gave the focus to nothing.
 */
export function useKeptFocus(
  around: RefObject<HTMLElement | null>,
  ...places: readonly RefObject<HTMLElement | null>[]
): void {
  const last = useRef<Element | null>(null);
  useEffect(() => {
    const node = around.current;
    const remember = ({ target }: FocusEvent) => {
      last.current = target instanceof Element ? target : null;
    };
    node?.addEventListener("focusin", remember);
    return () => node?.removeEventListener("focusin", remember);
  }, [around]);
  useEffect(() => {
    const had = last.current;
    if (had === null || document.activeElement !== document.body) return;
    // What is loading comes back.
    const isOff = had.matches(":disabled") && !had.hasAttribute("data-loading");
    if (had.isConnected && !isOff) return;
    last.current = null;
    places.find(({ current }) => current !== null)?.current?.focus();
  });
}
