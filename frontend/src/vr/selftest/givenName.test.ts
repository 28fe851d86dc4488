import { describe, expect, it } from "vitest";
import { givenName, keepName } from "./givenName";

describe("the name of this device", () => {
  it("is kept without blanks around it, and forgotten when it is emptied", () => {
    const kept = new Map<string, string>();
    const storage = {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => void kept.set(key, value),
      removeItem: (key: string) => void kept.delete(key),
    } as unknown as Storage;
    expect(givenName(storage)).toBe("");
    keepName(" Quest 3, room 2 ", storage);
    expect(givenName(storage)).toBe("Quest 3, room 2");
    keepName("\u202eQuest\u0007 4\u2069", storage);
    expect(givenName(storage)).toBe("Quest 4");
    keepName("  ", storage);
    expect(givenName(storage)).toBe("");
  });
});
