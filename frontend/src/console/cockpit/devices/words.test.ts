import type { SessionView } from "@shared/api/types";
import { expect, test } from "vitest";
import { at, session, steps } from "../example";
import { doing } from "./words";

const view = (more: Partial<SessionView>): SessionView => ({ ...session, ...more });

test("a tablet is read, answered or put down, by the step", () => {
  expect(doing(view({ current: at(0) }), "tablet")).toBe("reading");
  expect(doing(view({ current: at(3) }), "tablet")).toBe("answering");
  expect(doing(view({ current: at(2, { status: "running" }) }), "tablet")).toBe("waiting");
  expect(doing(view({ current: null }), "tablet")).toBeNull();
});

test("a form that is shown in the headset is answered there", () => {
  const inHeadset = steps.map((step) => ({ ...step, forms: "headset" as const }));
  const shown = view({ current: at(3), steps: inHeadset });
  expect(doing(shown, "headset")).toBe("answering");
  expect(doing(shown, "tablet")).toBe("waiting");
});

test("a headset moves while its phase runs, and stands while it is paused or not begun", () => {
  expect(doing(view({ current: at(2, { status: "walk_back" }) }), "headset")).toBe("moving");
  expect(doing(view({ current: at(2, { status: "paused" }) }), "headset")).toBe("paused");
  expect(doing(view({ current: at(2) }), "headset")).toBe("waiting");
});
