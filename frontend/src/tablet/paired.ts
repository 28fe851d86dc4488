/** Whether this tablet was paired before: then a refused cookie means that it was disconnected. */
const KEY = "reembody.tablet.paired";

export const rememberPaired = (): void => localStorage.setItem(KEY, "yes");
export const pairedBefore = (): boolean => localStorage.getItem(KEY) === "yes";
