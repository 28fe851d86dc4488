import { describe, expect, it } from "vitest";
import { inGroups } from "./NetworkPage";

describe("a fingerprint in groups", () => {
  it("loses no digit and keeps their order", () => {
    const pairs = Array.from({ length: 32 }, (_, at) => at.toString(16).padStart(2, "0"));
    const groups = inGroups(pairs.join(":"));
    expect(groups).toHaveLength(8);
    expect(groups.map(({ text }) => text).join(":")).toBe(pairs.join(":"));
  });
});
