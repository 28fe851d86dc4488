import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { type AvatarFile, differences } from "./axes";
import { loadVersion, mirror, resetGroup, setField, setJointField } from "./operations";

const MAKERS = { loadVersion, mirror, resetGroup, setField, setJointField };

/** `tests/vectors/avatar/README.md` describes the file. */
interface Vector {
  readonly calls: readonly {
    readonly call: keyof typeof MAKERS;
    readonly arguments: readonly unknown[];
    readonly operations: readonly unknown[];
  }[];
  readonly cases: readonly {
    readonly before: AvatarFile;
    readonly after: AvatarFile;
    readonly changed: readonly (readonly [string, unknown, unknown])[];
  }[];
}

const FILE = resolve(import.meta.dirname, "../../../../tests/vectors/avatar/edits.json");
const vector: Vector = JSON.parse(readFileSync(FILE, "utf8"));

describe("the page edits as the command does", () => {
  it.each(vector.calls)("$call makes the command's operations", (row) => {
    const made = MAKERS[row.call] as (...given: readonly unknown[]) => unknown;
    expect(made(...row.arguments)).toEqual(row.operations);
  });

  it("finds the command's differences, value by value", () => {
    expect(vector.cases.length).toBeGreaterThanOrEqual(15);
    for (const { before, after, changed } of vector.cases) {
      const found = differences(before, after).map((one) => [
        one.path.join("."),
        one.before ?? null,
        one.after ?? null,
      ]);
      expect(new Map(found.map((one) => [one[0], one]))).toEqual(
        new Map(changed.map((one) => [one[0], [...one]])),
      );
      expect(found).toHaveLength(changed.length);
    }
  });
});
