/**
 * Parts of a page that were needed and could not be loaded: the server was updated while the page
 * was open, so that they are gone, or it is out of reach.
 */

/** Why: the page is older than the server, the server does not answer, or neither can be told. */
export type UnloadedReason = "older" | "unreachable" | "unknown";

const errors = new WeakSet<object>();
const listeners = new Set<() => void>();
let reason: UnloadedReason | null = null;
let shownInPlace = 0;

/** Whether an error is that of a part which could not be loaded. */
export const isUnloaded = (error: unknown): boolean =>
  typeof error === "object" && error !== null && errors.has(error);

/** Remember the error of a part that could not be loaded, and find out why. */
export function reportUnloaded(error: unknown): void {
  if (typeof error === "object" && error !== null) errors.add(error);
  void find();
}

/** Hear of every import that fails; Vite tells the window before it rejects. */
export function followImports(): void {
  window.addEventListener("vite:preloadError", ({ payload }) => reportUnloaded(payload));
}

/** Fetch a part of the page that is not a script; the error of one that fails is remembered. */
export async function fetchPart(url: string): Promise<ArrayBuffer> {
  try {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url} could not be loaded (HTTP ${answer.status}).`);
    return await answer.arrayBuffer();
  } catch (error) {
    reportUnloaded(error);
    throw error;
  }
}

async function find(): Promise<UnloadedReason> {
  reason = await reasonNow();
  for (const listener of listeners) listener();
  return reason;
}

/** Reload the page if the server answers; otherwise stay, as the browser would show nothing. */
export async function reload(): Promise<void> {
  if ((await find()) !== "unreachable") window.location.reload();
}

/** The page's own address names the newest script: another one than ours means an update. */
async function reasonNow(): Promise<UnloadedReason> {
  const script = document.querySelector('script[type="module"][src]')?.getAttribute("src") ?? "";
  try {
    const answer = await fetch(window.location.pathname, {
      cache: "no-store",
      signal: AbortSignal.timeout(LONGEST_WAIT_MS),
    });
    if (!answer.ok) return "unreachable";
    return (await answer.text()).includes(script) ? "unknown" : "older";
  } catch {
    return "unreachable";
  }
}

const LONGEST_WAIT_MS = 8_000;

// What the page shows of it.

export function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Why a part could not be loaded; null if none failed, or it is not known yet. */
export const reasonFound = (): UnloadedReason | null => reason;

/** Whether it is said where the part would be, and need not be said beside the page. */
export const isShownInPlace = (): boolean => shownInPlace > 0;

/** Count a place that says it, until the returned function is called. */
export function showInPlace(): () => void {
  shownInPlace++;
  for (const listener of listeners) listener();
  return () => {
    shownInPlace--;
    for (const listener of listeners) listener();
  };
}

/** Forget what failed: somebody has read it, or another page is shown. */
export function dismiss(): void {
  reason = null;
  for (const listener of listeners) listener();
}
