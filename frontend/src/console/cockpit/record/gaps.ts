/** The gaps of a stream as they are told to people: the longest ones, with both ends included. */

export interface Gap {
  readonly first: number;
  readonly last: number;
}

/** More are counted only: a network that fails again and again leaves hundreds. */
const MOST = 4;

/** The longest of `gaps`, each as its first seq and the one after its last, in their order. */
export function shownGaps(gaps: readonly (readonly [number, number])[]): {
  readonly shown: readonly Gap[];
  readonly more: number;
} {
  const longest = [...gaps]
    .sort((one, other) => other[1] - other[0] - (one[1] - one[0]))
    .slice(0, MOST)
    .sort((one, other) => one[0] - other[0]);
  const shown = longest.map(([first, end]) => ({ first, last: end - 1 }));
  return { shown, more: gaps.length - shown.length };
}
