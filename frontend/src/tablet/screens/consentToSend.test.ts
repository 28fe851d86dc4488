import { describe, expect, it } from "vitest";
import { consentToSend, lengthOf, missingOf, UNSIGNED } from "./consentToSend";

const text = "I agree.";
const drawn = {
  signature: "drawn",
  statements: [
    { text, optional: false },
    { text, optional: true },
  ],
} as const;
const signed = { ...UNSIGNED, ticked: [0], path: "M10 10L100 10" };

describe("a consent", () => {
  it("is complete once every required statement is ticked and it is signed", () => {
    expect(missingOf(drawn, UNSIGNED)).toBe("statements");
    expect(missingOf(drawn, { ...signed, path: "" })).toBe("signature");
    expect(missingOf(drawn, signed)).toBeNull();
  });

  it("does not accept an accidental stroke as a signature", () => {
    expect(missingOf(drawn, { ...signed, path: "M10 10M20 20L30 20" })).toBe("signature");
    expect(lengthOf("M0 0L30 40M5 5L5 15")).toBe(60);
  });

  it("accepts a typed name instead of a drawing, and sends only that", () => {
    const typed = { ...signed, types: true, name: " A. Person " };
    expect(missingOf(drawn, { ...typed, name: " " })).toBe("name");
    expect(missingOf(drawn, typed)).toBeNull();
    expect(consentToSend(drawn, typed, 3)).toEqual({
      step_index: 3,
      ticked: [0],
      name: "A. Person",
      signature: null,
    });
  });

  it("without a signature needs only its statements, and sends no name", () => {
    const plain = { signature: "none", statements: drawn.statements } as const;
    expect(missingOf(plain, signed)).toBeNull();
    expect(consentToSend(plain, { ...signed, name: "x" }, 0)).toMatchObject({
      name: null,
      signature: null,
    });
  });
});
