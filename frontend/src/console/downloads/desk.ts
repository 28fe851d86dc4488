/**
 * What this tab has ordered: such a file is handed to the browser as soon as it is ready. It is
 * remembered over a reload of the page, and other tabs do not fetch it as well.
 */
import { useSyncExternalStore } from "react";

const KEY = "reembody.downloads.wanted";

interface Desk {
  readonly opened: boolean;
  /** Exports that were ordered here and are not handed over yet. */
  readonly wanted: readonly string[];
  /** One of them vanished before it was ready. */
  readonly gone: boolean;
}

let desk: Desk = { opened: false, wanted: kept(), gone: false };
const listeners = new Set<() => void>();

function kept(): readonly string[] {
  return (sessionStorage.getItem(KEY) ?? "").split(" ").filter((id) => id !== "");
}

function change(next: Partial<Desk>): void {
  desk = { ...desk, ...next };
  sessionStorage.setItem(KEY, desk.wanted.join(" "));
  for (const listener of listeners) listener();
}

export const openDownloads = (): void => change({ opened: true });
export const closeDownloads = (): void => change({ opened: false, gone: false });
export const want = (id: string): void =>
  change({ wanted: [...desk.wanted.filter((one) => one !== id), id], gone: false });
export const wantNoMore = (id: string, gone = false): void =>
  change({ wanted: desk.wanted.filter((one) => one !== id), gone: desk.gone || gone });

export function useDesk(): Desk {
  return useSyncExternalStore(
    (listener) => {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    () => desk,
  );
}
