/**
 * The key under which it is stored that this tablet was paired: a rejected cookie then means that
 * it was disconnected.
 */
const KEY = "reembody.tablet.paired";

export const rememberPaired = (): void => localStorage.setItem(KEY, "yes");
export const pairedBefore = (): boolean => localStorage.getItem(KEY) === "yes";
