import { describe, expect, it } from "vitest";
import { helpFor } from "./address";
import { helpPagesDe, helpPagesEn } from "./helpTexts";
import type { HelpPart } from "./nodes";
import { search } from "./search";

describe("the key ?", () => {
  it("opens the help about the current page, or the tour", () => {
    expect(helpFor("/studies/a/participants")).toBe("/help/participants-rights");
    expect(helpFor("/equipment")).toBe("/help/headsets");
    expect(helpFor("/")).toBe("/help/operators-tour");
  });
});

describe("the search", () => {
  const page = (key: string, title: string, ...titles: string[]) => ({
    key,
    title,
    about: "",
    headings: titles.map((one) => ({
      id: one.toLowerCase().replaceAll(" ", "-"),
      level: 2,
      title: one,
    })),
    load: async () => ({ body: [] }),
  });
  const parts: readonly HelpPart[] = [
    {
      title: "Run",
      pages: [
        page("backups", "Backups", "Restoring", "The drill"),
        page("rights", "Rights", "Restoring an older backup"),
      ],
    },
  ];
  const found = (query: string) =>
    search(parts, query).map(({ page: { key }, heading }) => `${key}#${heading?.id ?? ""}`);

  it("matches headings by the title of their page, too", () => {
    expect(found("backup restor")).toEqual([
      "backups#restoring",
      "rights#restoring-an-older-backup",
    ]);
  });

  it("lists what starts with the query first, and finds nothing for an empty query", () => {
    expect(found("restoring")).toEqual(["backups#restoring", "rights#restoring-an-older-backup"]);
    expect(found("backup")[0]).toBe("backups#");
    expect(found("  ")).toEqual([]);
    expect(found("nonsense")).toEqual([]);
  });
});

describe("the texts of the help", () => {
  it("exist in both languages", () => {
    expect(Object.keys(helpPagesDe)).toEqual(Object.keys(helpPagesEn));
  });
});
