/** Which study a newcomer is shown. */

/** The study that everybody has, and that needs no preparation. */
const SHIPPED = "reembodiment-latency";

/** The study whose page is open, else the one that everybody has, else the first. */
export function choose(address: string, keys: readonly string[]): string | null {
  const here = /^\/studies\/([^/?]+)/.exec(address)?.[1];
  return keys.find((key) => key === here) ?? keys.find((key) => key === SHIPPED) ?? keys[0] ?? null;
}
