import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { listedParts, loadDocs, pageFrom, slugOf } from "./helpPages.ts";
import { HELPS } from "./src/console/help/address.ts";

const nowhere = () => "elsewhere" as const;

describe("the table of contents in the docs", () => {
  it("lists parts, pages and their sentences, without the pages for developers", () => {
    const map = [
      "# Documentation",
      "## Start",
      "- [The tour](operators-tour.md): from an empty room.",
      "- [Every page](pages.md): pictures.",
      "## Write",
      "- [Your own study](../study_configs/README.md): the file.",
      "- [Parts](sbom.cdx.json): every package.",
    ];
    expect(listedParts(map.join("\n"))).toEqual([
      {
        title: "Start",
        pages: [
          {
            key: "operators-tour",
            title: "The tour",
            file: "docs/operators-tour.md",
            about: "from an empty room.",
          },
        ],
      },
      {
        title: "Write",
        pages: [
          {
            key: "study-configs",
            title: "Your own study",
            file: "study_configs/README.md",
            about: "the file.",
          },
        ],
      },
    ]);
  });
});

describe("a help page", () => {
  it("is parsed into a tree of elements, with special characters kept as text", () => {
    const { body, headings } = pageFrom("# A & B\n\n## C `d`\n\nOne **two** `a < b`.", nowhere);
    expect(headings).toEqual([{ id: "c-d", level: 2, title: "C d" }]);
    expect(body).toEqual([
      ["h1", { id: "a--b" }, "A & B"],
      ["h2", { id: "c-d" }, "C ", ["code", {}, "d"]],
      ["p", {}, "One ", ["strong", {}, "two"], " ", ["code", {}, "a < b"], "."],
    ]);
  });

  it("keeps links to other help pages and drops other links, but not their words", () => {
    const follow = (target: string) =>
      target === "a.md" ? { to: "/help/a" } : ("elsewhere" as const);
    expect(pageFrom("[here](a.md) and [there](b.py)", follow).body).toEqual([
      ["p", {}, ["a", { to: "/help/a" }, "here"], " and ", "there"],
    ]);
  });

  it("supports tables whose cells contain a vertical bar, and refers to pictures by number", () => {
    const follow = () => ({ picture: "/x.png" });
    const { body, pictures } = pageFrom("| a |\n|---|\n| `b\\|c` |\n\n![d](x.png)", follow);
    expect(pictures).toEqual(["/x.png"]);
    expect(JSON.stringify(body)).toContain('["td",{},["code",{},"b|c"]]');
    expect(JSON.stringify(body)).toContain('["img",{"src":"picture:0","alt":"d"}]');
  });

  it("numbers headings that have the same text, as GitHub does", () => {
    const { headings } = pageFrom("## A\n\n## A\n", nowhere);
    expect(headings.map(({ id }) => id)).toEqual(["a", "a-1"]);
    expect(slugOf("9. What cannot be true?")).toBe("9-what-cannot-be-true");
  });

  it("fails the build when it contains Markdown that cannot be shown", () => {
    expect(() => pageFrom("> quoted", nowhere)).toThrow("blockquote");
  });
});

describe("all pages of the docs", () => {
  it("can be converted, and every link from the console leads to one of them", () => {
    const docs = loadDocs(resolve(import.meta.dirname, ".."));
    const contents = docs.contents();
    const keys = [...contents.matchAll(/"virtual:help\/([\w-]+)"/g)].map(([, key]) => key);
    expect(keys.length).toBeGreaterThan(20);
    for (const key of keys) expect(docs.body(String(key))).toContain("export const body");
    expect(HELPS.filter(([, key]) => !keys.includes(key))).toEqual([]);
  });
});
