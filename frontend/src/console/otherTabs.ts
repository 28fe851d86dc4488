/**
 * The other tabs of this browser, which share its sign-in: whoever signs in or out in one of them
 * does so in all.
 */
import { accountOfPage, onOtherAccount } from "@shared/api/request";
import { useSyncExternalStore } from "react";

const channel = new BroadcastChannel("reembody-account");
const changeListeners = new Set<() => void>();
const sameListeners = new Set<() => void>();
let changed = false;

channel.onmessage = ({ data }: MessageEvent<string | null>) => {
  if (data !== accountOfPage()) change();
  else for (const listener of sameListeners) listener();
};
onOtherAccount(change);

function change(): void {
  changed = true;
  for (const listener of changeListeners) listener();
}

/** Tell the other tabs whose sign-in the browser has now; null if it has none. */
export const tellOtherTabs = (account: string | null): void => channel.postMessage(account);

/** Hear when the account that this page shows has signed in in another tab. */
export function onSameAccount(listener: () => void): () => void {
  sameListeners.add(listener);
  return () => sameListeners.delete(listener);
}

/** Hear when the browser's account is no longer the one that this page shows. */
export function onAccountChange(listener: () => void): () => void {
  changeListeners.add(listener);
  return () => changeListeners.delete(listener);
}

export const hasAccountChanged = (): boolean => changed;

/** Whether the browser's account is no longer the one that this page shows. */
export const useAccountChanged = (): boolean =>
  useSyncExternalStore(onAccountChange, hasAccountChanged);
