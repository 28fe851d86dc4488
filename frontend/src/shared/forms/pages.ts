/**
 * Distribute the items of a form over pages.
 *
 * A page has few items of one kind, so that nobody has to scroll and each item gets its own
 * attention; the items keep their given order, because that order is part of the data.
 */
import type { Item } from "../api/types";

type Family = "scale" | "fine" | "facts" | "prose";

/** The most items on a page: as many as fit a tablet in both orientations without scrolling. */
const MAX_ITEMS: Readonly<Record<Family, number>> = {
  scale: 3,
  fine: 2,
  facts: 3,
  prose: 2,
};

/** A scale with more steps needs two rows of buttons, so that each is as wide as a finger. */
export const STEPS_IN_A_ROW = 11;

/** Split items into pages; `steps` returns the number of answers on a rated item's scale. */
export function pagesOf(
  items: readonly Item[],
  steps: (item: Item) => number = () => 0,
): readonly (readonly Item[])[] {
  const runs = runsOf(items, (item) => familyOf(item, steps(item)));
  return joinShortEnd(runs.flatMap(({ family, items: run }) => evenly(run, MAX_ITEMS[family])));
}

function familyOf(item: Item, steps = 0): Family {
  if (item.type === "likert") return steps > STEPS_IN_A_ROW ? "fine" : "scale";
  return item.type === "text" && isLong(item) ? "prose" : "facts";
}

const SHORT_TEXT = 200;

/** Texts with a large limit or none get a field of several lines. */
export const isLong = (item: Item): boolean =>
  (item.max_length ?? Number.POSITIVE_INFINITY) > SHORT_TEXT;

function runsOf(
  items: readonly Item[],
  kindOf: (item: Item) => Family,
): readonly { family: Family; items: Item[] }[] {
  const runs: { family: Family; items: Item[] }[] = [];
  for (const item of items) {
    const family = kindOf(item);
    const last = runs.at(-1);
    if (last?.family === family) last.items.push(item);
    else runs.push({ family, items: [item] });
  }
  return runs;
}

/** Split items into as few pages as `most` allows, as evenly as possible. */
function evenly(items: readonly Item[], most: number): readonly (readonly Item[])[] {
  const count = Math.ceil(items.length / most);
  const pages: (readonly Item[])[] = [];
  for (let page = 0, start = 0; page < count; page += 1) {
    const size = Math.ceil((items.length - start) / (count - page));
    pages.push(items.slice(start, start + size));
    start += size;
  }
  return pages;
}

/** Move a single open question to the page before it, if that one has room. */
function joinShortEnd(pages: readonly (readonly Item[])[]): readonly (readonly Item[])[] {
  const last = pages.at(-1);
  const before = pages.at(-2);
  if (last === undefined || before === undefined) return pages;
  const fits =
    last.length === 1 && before.length <= 2 && last.every((item) => familyOf(item) === "prose");
  return fits ? [...pages.slice(0, -2), [...before, ...last]] : pages;
}
