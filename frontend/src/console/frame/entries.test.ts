import { expect, test } from "vitest";
import { type Entry, found } from "./entries";

const entry = (kind: Entry["kind"], title: string, about = ""): Entry => ({
  kind,
  id: `${kind} ${title}`,
  icon: "document",
  title,
  about,
  go: "/",
});

const ALL = [
  entry("help", "Statistics", "How every test is computed"),
  entry("sessions", "P-0012", "Latency study, completed"),
  entry("pages", "Storage"),
  entry("pages", "Statistics", "Results"),
  entry("settings", "Dark appearance"),
];
const titles = (query: string) => found(ALL, query).map(({ kind, title }) => `${kind}: ${title}`);

test("a word finds pages before help, and titles that begin with it first", () => {
  expect(titles("st")).toEqual([
    "pages: Storage",
    "pages: Statistics",
    "sessions: P-0012",
    "help: Statistics",
  ]);
});

test("every word has to be there, in any order and case, in the title or in what it belongs to", () => {
  expect(titles("LATENCY 0012")).toEqual(["sessions: P-0012"]);
  expect(titles("0012 hand")).toEqual([]);
});

test("without a word it offers pages and settings, never somebody's sessions", () => {
  expect(titles(" ")).toEqual(["pages: Storage", "pages: Statistics", "settings: Dark appearance"]);
});

test("a thousand sessions do not push the help out of sight", () => {
  const many = Array.from({ length: 1000 }, (_, at) => entry("sessions", `Statistics ${at}`));
  const shown = found([...many, ...ALL], "statistics");
  expect(shown.filter(({ kind }) => kind === "sessions")).toHaveLength(8);
  expect(shown.some(({ kind }) => kind === "help")).toBe(true);
});
