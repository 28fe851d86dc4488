import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { eventsEn } from "./eventTexts";

const EVENTS = new URL(
  "../../../../../app/features/record/sessions/engine/events.py",
  import.meta.url,
);

test("every event that the server appends has a name", () => {
  const types = [...readFileSync(EVENTS, "utf8").matchAll(/^ {4}type = "(\w+)"$/gm)].map(
    ([, type]) => `event.${type}`,
  );
  expect(types.length).toBeGreaterThan(30);
  expect(
    Object.keys(eventsEn)
      .filter((key) => key.startsWith("event."))
      .toSorted(),
  ).toEqual(types.toSorted());
});
