import { describe, expect, it } from "vitest";
import { studyToTry } from "./studyToTry";

describe("The study that is tried", () => {
  const keys = ["first", "own", "reembodiment-latency"];

  it("is the open one, else the one that the sidebar shows, else the shipped one", () => {
    expect(studyToTry("/studies/first/protocol", keys, "own")).toBe("first");
    expect(studyToTry("/", keys, "own")).toBe("own");
    expect(studyToTry("/", keys, "deleted")).toBe("reembodiment-latency");
    expect(studyToTry("/", ["first", "own"], null)).toBe("first");
    expect(studyToTry("/", [], "own")).toBeNull();
  });
});
