import { expect, test } from "vitest";
import {
  isAllowed,
  isAt,
  isReadable,
  isWide,
  LAB_PAGES,
  SECTIONS,
  sectionAt,
  studyIn,
} from "./places";

test("a study's address names the study and its section, by default the overview", () => {
  expect(studyIn("/studies/two%20words/ledger")).toBe("two words");
  expect(sectionAt("/studies/latency")).toBe("overview");
  expect(sectionAt("/studies/latency/statistics")).toBe("statistics");
  expect(sectionAt("/studies/latency/nonsense")).toBe("overview");
  expect(studyIn("/captures")).toBeNull();
  expect(sectionAt("/captures/a/joints")).toBeNull();
});

test("an address that cannot be decoded is no study's, and nobody's", () => {
  for (const address of ["/studies/%", "/studies/%E0%A4%A", "/studies/%zz/dashboard"]) {
    expect(studyIn(address)).toBeNull();
    expect(isReadable(address)).toBe(false);
  }
  expect(isReadable("/studies/two%20words")).toBe(true);
});

test("a page counts as current for the addresses below it, and for no other that begins alike", () => {
  expect(isAt("/captures/a/joints", "/captures")).toBe(true);
  expect(isAt("/captures-of-mine", "/captures")).toBe(false);
});

test("an operator sees no results and nobody but administrators sees the accounts", () => {
  const results = SECTIONS.filter(({ group }) => group === "results");
  expect(results.some((section) => isAllowed(section, "operator"))).toBe(false);
  expect(results.every((section) => isAllowed(section, "analyst"))).toBe(true);
  const people = LAB_PAGES.find(({ href }) => href === "/people");
  expect(people !== undefined && isAllowed(people, "experimenter")).toBe(false);
  expect(people !== undefined && isAllowed(people, "admin")).toBe(true);
});

test("the cockpit, replays and editors take the sidebar's width, lists do not", () => {
  expect(isWide("/sessions/abc")).toBe(true);
  expect(isWide("/studies/latency/edit")).toBe(true);
  expect(isWide("/avatars/standard")).toBe(true);
  expect(isWide("/avatars")).toBe(false);
  expect(isWide("/studies/latency/sessions")).toBe(false);
});
