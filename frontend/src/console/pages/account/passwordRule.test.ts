/** Check that the page's password rule is the one that the server enforces. */
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { checkPassword, isGood, MAX_LENGTH, MIN_DIFFERENT, MIN_LENGTH } from "./passwordRule";

const SERVER = readFileSync(
  new URL("../../../../../app/features/people/accounts/passwords.py", import.meta.url),
  "utf-8",
);
const limit = (name: string) => Number(new RegExp(`^${name} = (\\d+)$`, "m").exec(SERVER)?.[1]);

describe("the rule for passwords", () => {
  it("has the server's limits", () => {
    expect([MIN_LENGTH, MAX_LENGTH, MIN_DIFFERENT]).toEqual([
      limit("MIN_LENGTH"),
      limit("MAX_LENGTH"),
      limit("MIN_DIFFERENT"),
    ]);
  });

  it.each([
    ["correct horse battery", "ada", true],
    ["short words", "ada", false],
    ["abababababababab", "ada", false],
    ["ada.lovelace1", "ada.lovelace", false],
    ["Reembody-2026", "ada", false],
    ["reembody is what we run", "ada", true],
  ])("says of %j for %j: %j", (password, username, good) => {
    expect(isGood(checkPassword(password, password, username))).toBe(good);
  });

  it("requires both entries to be equal", () => {
    expect(checkPassword("correct horse battery", "correct horse", "ada").same).toBe(false);
  });
});
