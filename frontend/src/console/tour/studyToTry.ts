/** Which study is tried out where none is named. */

/** The study that is shipped with the product and needs no preparation. */
const SHIPPED = "reembodiment-latency";

/** The study whose page is open, else the one that was open last, the shipped one, or the first. */
export function studyToTry(
  address: string,
  keys: readonly string[],
  last: string | null,
): string | null {
  const here = /^\/studies\/([^/?]+)/.exec(address)?.[1];
  const known = [here, last, SHIPPED].find((key) => key != null && keys.includes(key));
  return known ?? keys[0] ?? null;
}
