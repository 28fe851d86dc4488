import { describe, expect, it } from "vitest";
import type { Item } from "../api/types";
import { instrument, likert } from "./example";
import { pagesOf } from "./pages";

const keys = (pages: readonly (readonly Item[])[]) =>
  pages.map((page) => page.map(({ key }) => key));
const scale = (count: number): Item[] =>
  Array.from({ length: count }, (_, index) => likert(`q${index + 1}`));
const open: Item = { key: "open", text: { en: "Open" }, type: "text" };

describe("pages of a form", () => {
  it("keep every item once and in the order given", () => {
    for (const count of [1, 3, 4, 7, 14, 25]) {
      const items = [...scale(count), open];
      expect(pagesOf(items).flat()).toEqual(items);
    }
    expect(pagesOf(instrument.items).flat()).toEqual(instrument.items);
  });

  it("contain at most three rated items, as evenly as possible", () => {
    const sizes = pagesOf(scale(14)).map((page) => page.length);
    expect(sizes).toEqual([3, 3, 3, 3, 2]);
    expect(pagesOf(scale(4)).map((page) => page.length)).toEqual([2, 2]);
  });

  it("let a single open question share a page that has room", () => {
    const pages = keys(pagesOf([...scale(14), open]));
    expect(pages).toHaveLength(5);
    expect(pages.at(-1)).toEqual(["q13", "q14", "open"]);
    expect(keys(pagesOf([...scale(3), open]))).toEqual([["q1", "q2", "q3"], ["open"]]);
  });

  it("contain at most two items of a scale that needs two rows of buttons", () => {
    expect(pagesOf(scale(6), () => 21).map((page) => page.length)).toEqual([2, 2, 2]);
    expect(pagesOf(scale(6), () => 11).map((page) => page.length)).toEqual([3, 3]);
  });
});
