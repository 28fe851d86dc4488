/**
 * How the items of a form are spread over pages.
 *
 * A page holds few items of one kind, so that nothing has to be scrolled and each answer gets its
 * own look; the items keep the order they are given in, because that order is part of the data.
 */
import type { Item } from "../api/types";

type Family = "scale" | "fine" | "facts" | "prose";

/** At most so many items on a page: what fits a tablet in both directions without scrolling. */
const MOST: Readonly<Record<Family, number>> = {
  scale: 3,
  fine: 2,
  facts: 3,
  prose: 2,
};

/** A scale of more steps needs two rows of buttons, so that each is as wide as a finger. */
export const STEPS_IN_A_ROW = 11;

/** `steps`: how many answers the scale of a rated item has. */
export function pagesOf(
  items: readonly Item[],
  steps: (item: Item) => number = () => 0,
): readonly (readonly Item[])[] {
  const runs = runsOf(items, (item) => familyOf(item, steps(item)));
  return joinShortEnd(runs.flatMap(({ family, items: run }) => evenly(run, MOST[family])));
}

function familyOf(item: Item, steps = 0): Family {
  if (item.type === "likert") return steps > STEPS_IN_A_ROW ? "fine" : "scale";
  return item.type === "text" && isLong(item) ? "prose" : "facts";
}

const SHORT_TEXT = 200;

/** Texts without a limit, or with a large one, get a field of several lines. */
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

/** As few pages as `most` allows, and as equally full as they can be. */
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

/** A single open question shares the page before it, where that one has room. */
function joinShortEnd(pages: readonly (readonly Item[])[]): readonly (readonly Item[])[] {
  const last = pages.at(-1);
  const before = pages.at(-2);
  if (last === undefined || before === undefined) return pages;
  const fits =
    last.length === 1 && before.length <= 2 && last.every((item) => familyOf(item) === "prose");
  return fits ? [...pages.slice(0, -2), [...before, ...last]] : pages;
}
