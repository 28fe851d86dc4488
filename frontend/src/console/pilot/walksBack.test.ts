import { expect, test } from "vitest";
import type { PilotListed } from "./pilots";
import { walksBackOf } from "./walksBack";

const pilot = (fields: Partial<PilotListed>): PilotListed =>
  ({
    kind: "cohort",
    state: "ready",
    content_hash: "a",
    walk_back_min: 1,
    ...fields,
  }) as PilotListed;

test("the newest finished cohort of the very same content says how long the walks back are", () => {
  const known = [
    pilot({ kind: "power", walk_back_min: null }),
    pilot({ state: "simulating", walk_back_min: null }),
    pilot({ content_hash: "b", walk_back_min: 9 }),
    pilot({ walk_back_min: 2 }),
    pilot({ walk_back_min: 3 }),
  ];
  expect(walksBackOf(known, "a")).toBe(2);
});

test("without a pilot of this content nothing is said", () => {
  expect(walksBackOf([pilot({})], "c")).toBeNull();
  expect(walksBackOf([pilot({})], null)).toBeNull();
  expect(walksBackOf(undefined, "a")).toBeNull();
});
