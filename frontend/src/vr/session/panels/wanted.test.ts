import { describe, expect, it } from "vitest";
import type { PanelOrder } from "../../telemetry";
import { PANEL } from "../testing";
import { type Situation, wanted } from "./wanted";

const ORDER = { ...PANEL, title: "Step" };
const CALM: Situation = {
  place: "acting",
  order: ORDER,
  stepKind: "task",
  stepIndex: 4,
  phase: null,
  areFeetTracked: true,
  looksAround: false,
  secondsLeft: 0,
  stop: null,
  isOffline: false,
  isNearEdge: false,
  boundary: null,
};

const kind = (now: Partial<Situation>, order: Partial<PanelOrder> = {}): string =>
  wanted({ ...CALM, order: { ...ORDER, ...order }, ...now }).kind;

describe("the panel that is wanted", () => {
  it("follows the step between phases", () => {
    expect(kind({})).toBe("ready");
    expect(kind({ stepKind: null, place: "standby" })).toBe("standby");
    expect(kind({ stepKind: "height", place: "standby" })).toBe("waiting");
    expect(kind({ stepKind: "materialise", place: "stepping_in" })).toBe("stepping_in");
    expect(kind({}, { form: "a#1", answer: "headset" })).toBe("form");
    expect(kind({}, { answer: "oral" })).toBe("aloud");
    expect(wanted({ ...CALM, order: { ...ORDER, answer: "tablet", headset_off: true } })).toEqual({
      kind: "take_off",
      isForm: true,
    });
    expect(kind({}, { acknowledge: true, text: "Read this." })).toBe("reading");
    expect(kind({}, { held: true })).toBe("waiting");
    expect(kind({ place: "over" })).toBe("finished");
  });

  it("leaves the view free while a phase runs, and says what its other moments ask for", () => {
    expect(kind({ phase: "running" })).toBe("nothing");
    expect(kind({ phase: "preparing", secondsLeft: 3 })).toBe("preparing");
    expect(kind({ phase: "to_start" })).toBe("to_start");
    expect(kind({ phase: "to_start", isOffline: true })).toBe("offline");
    expect(kind({ phase: "frozen" })).toBe("screen_text");
    expect(kind({ phase: "walk_back" })).toBe("screen_text");
    expect(kind({ phase: "paused" })).toBe("pause");
  });

  it("puts the edge of the room before everything, and a stop before all else", () => {
    const form = { form: "a#1", answer: "headset" } as const;
    expect(kind({ isNearEdge: true, stop: "told", phase: "running" })).toBe("edge");
    expect(kind({ stop: "told", isOffline: true }, form)).toBe("pause");
    expect(kind({ isOffline: true }, form)).toBe("form");
    expect(kind({ isOffline: true })).toBe("offline");
    expect(kind({ isOffline: true, phase: "running" })).toBe("nothing");
  });

  it("asks to look around until trackers are aligned, between whatever else is to be done", () => {
    expect(kind({ looksAround: true })).toBe("look_around");
    expect(kind({ looksAround: true, stepKind: null, place: "standby" })).toBe("look_around");
    expect(kind({ looksAround: true }, { form: "a#1", answer: "headset" })).toBe("form");
    expect(kind({ looksAround: true, phase: "running" })).toBe("nothing");
  });

  it("says that a foot task cannot start while the feet are not measured", () => {
    expect(kind({ areFeetTracked: false }, { limb: "foot" })).toBe("feet");
    expect(kind({ areFeetTracked: false }, { limb: "hand" })).toBe("ready");
    expect(kind({ areFeetTracked: true }, { limb: "foot" })).toBe("ready");
    // Somebody has overridden the check, with a reason.
    expect(kind({ areFeetTracked: false, phase: "running" }, { limb: "foot" })).toBe("nothing");
  });

  it("warns of a room that is too small before the body is entered, not afterwards", () => {
    expect(kind({ boundary: "too_small", place: "standby" })).toBe("boundary");
    expect(kind({ boundary: "missing", place: "stepping_in" })).toBe("boundary");
    expect(kind({ boundary: "missing" })).toBe("ready");
  });

  it("shows a server of an earlier release no panel but what the headset knows itself", () => {
    expect(wanted({ ...CALM, order: null }).kind).toBe("nothing");
    expect(wanted({ ...CALM, order: null, phase: "paused" }).kind).toBe("pause");
    expect(wanted({ ...CALM, order: null, place: "stepping_in" }).kind).toBe("stepping_in");
  });
});
