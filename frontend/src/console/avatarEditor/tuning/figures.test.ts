import { describe, expect, it } from "vitest";
import { differenceInWords } from "./figures";

describe("a difference", () => {
  it("that is too small for its digits says so, with its sign; zero is written out", () => {
    expect(differenceInWords(0.0049, "en")).toBe("< 0.005");
    expect(differenceInWords(-1e-7, "en")).toBe("> −0.005");
    expect(differenceInWords(-1e-7, "de")).toBe("> −0,005");
    expect(differenceInWords(0, "en")).toBe("0.00");
    expect(differenceInWords(0.25, "en")).toBe("0.25");
    expect(differenceInWords(undefined, "en")).toBe("–");
  });
});
