/**
 * The name that people gave this device, such as "Quest 3, room 2": typed once, kept by the browser.
 *
 * The cockpit, the page Equipment and the exports show it, so that two headsets can be told apart.
 */

const KEY = "reembody.vr.device-name";
/** The server takes no longer names. */
export const LONGEST_NAME = 80;

/** The name as it was typed; empty if none was. */
export const givenName = (storage: Pick<Storage, "getItem"> = localStorage): string =>
  storage.getItem(KEY) ?? "";

/** Control characters, and those that turn writing around: the server takes no name with them. */
const NOT_PLAIN = /[\p{Cc}\p{Bidi_Control}\u2028\u2029]/gu;

/** Keep a name from now on, as plain text; an empty one is forgotten. */
export function keepName(name: string, storage: Storage = localStorage): void {
  const plain = name.replace(NOT_PLAIN, "").trim();
  if (plain === "") storage.removeItem(KEY);
  else storage.setItem(KEY, plain.slice(0, LONGEST_NAME));
}
