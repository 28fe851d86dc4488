import { describe, expect, it } from "vitest";
import { codeCharacters, codeFromAddress, writtenCode } from "./pairingCode";

describe("a pairing code", () => {
  it("is accepted however it is typed", () => {
    expect(codeCharacters(" 4fq-7kp ")).toBe("4FQ7KP");
    expect(codeCharacters("4FQ-7KPX9")).toBe("4FQ7KP");
  });

  it("is written in two groups", () => {
    expect(["4", "4FQ", "4FQ7", "4FQ7KP"].map(writtenCode)).toEqual([
      "4",
      "4FQ",
      "4FQ-7",
      "4FQ-7KP",
    ]);
  });

  it("is removed from the address that contained it", () => {
    const address = new URL("https://lab.example/tablet?code=4FQ-7KP&x=1#top");
    expect(codeFromAddress(address)).toEqual({ code: "4FQ-7KP", rest: "/tablet?x=1#top" });
  });

  it("is null if the address has none or only half of one", () => {
    expect(codeFromAddress(new URL("https://lab.example/tablet")).code).toBeNull();
    expect(codeFromAddress(new URL("https://lab.example/tablet?code=4FQ")).code).toBeNull();
  });
});
