/** The text size that the participant chose: kept on this tablet until its page is closed. */
export const TEXT_SIZES = [1, 1.2, 1.45] as const;
export type TextSize = (typeof TEXT_SIZES)[number];

const KEY = "reembody.tablet.textSize";

/** The stored size; the usual one if none is stored or the stored one is invalid. */
export function storedSize(stored: string | null): TextSize {
  return TEXT_SIZES.find((size) => String(size) === stored) ?? 1;
}

/** The next larger size; after the largest, the usual one. */
export function nextSize(size: TextSize): TextSize {
  return TEXT_SIZES[(TEXT_SIZES.indexOf(size) + 1) % TEXT_SIZES.length] ?? 1;
}

export const chosenSize = (): TextSize => storedSize(sessionStorage.getItem(KEY));

/** Show the page in this size, now and after a reload. */
export function applySize(size: TextSize): void {
  document.documentElement.style.setProperty("--text-scale", String(size));
  sessionStorage.setItem(KEY, String(size));
}
