/** A click follows the release of a finger, a mouse button or a key within this time. */
const CLICK_MS = 100;
/** Nobody presses longer than this for a click; a release outside of the window is never heard of. */
const LONGEST_MS = 2000;

/**
 * Follow what is pressed; what is returned waits until nothing is.
 *
 * Whoever replaces what is pressed would lose the click.
 */
export function watchPresses(signal: AbortSignal): () => Promise<void> {
  let quietAt = 0;
  const quietIn = (ms: number) => () => {
    quietAt = performance.now() + ms;
  };
  const options = { signal, capture: true, passive: true };
  for (const kind of ["pointerdown", "keydown"]) {
    document.addEventListener(kind, quietIn(LONGEST_MS), options);
  }
  for (const kind of ["pointerup", "pointercancel", "keyup"]) {
    document.addEventListener(kind, quietIn(CLICK_MS), options);
  }
  return async () => {
    while (performance.now() < quietAt) await new Promise((resolve) => setTimeout(resolve, 10));
  };
}
