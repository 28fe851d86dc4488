import { describe, expect, it } from "vitest";
import { keepSearch, withOwnSearch } from "./ownSearch";

function kept() {
  const stored = new Map<string, string>();
  return {
    getItem: (name: string) => stored.get(name) ?? null,
    setItem: (name: string, text: string) => void stored.set(name, text),
    removeItem: (name: string) => void stored.delete(name),
  };
}

describe("the search of an address", () => {
  const dashboard = "/studies/a/dashboard";

  it("is given back to its page, and to no other page or study", () => {
    const tab = kept();
    keepSearch(dashboard, "rows=all&limb=foot", tab);
    expect(withOwnSearch(dashboard, tab)).toBe(`${dashboard}?rows=all&limb=foot`);
    // An empty search: without one the router would keep that of the page before.
    expect(withOwnSearch("/studies/a/versions", tab)).toBe("/studies/a/versions?");
    expect(withOwnSearch("/studies/b/dashboard", tab)).toBe("/studies/b/dashboard?");
  });

  it("is the one that an address names, and nothing once it was emptied", () => {
    const tab = kept();
    keepSearch(dashboard, "rows=all", tab);
    expect(withOwnSearch(`${dashboard}?limb=hand`, tab)).toBe(`${dashboard}?limb=hand`);
    keepSearch(dashboard, "", tab);
    expect(withOwnSearch(dashboard, tab)).toBe(`${dashboard}?`);
  });
});
