import type { SessionRoad } from "@shared/api/road";
import type { Allowed, Current, SessionView, Step } from "@shared/api/types";
import { describe, expect, it } from "vitest";
import { at, session, steps } from "./example";
import { groupSteps } from "./record/Timeline";
import {
  awaitsHeadset,
  guidance,
  hiddenBecause,
  isBlocked,
  lacksHeadset,
  primaryAction,
  redoable,
  redoTarget,
} from "./session/action";
import { changesBetween, isOutdated } from "./session/useSession";
import { beforeCrossing } from "./step/PhaseClock";

type RoadNow = NonNullable<SessionRoad["now"]>;

const view = (
  current: Current | null,
  allowed: readonly Allowed[],
  more: Partial<SessionView> = {},
) => ({
  ...session,
  current,
  allowed,
  ...more,
});

describe("the primary action", () => {
  it("is never one that the server does not allow", () => {
    for (const index of steps.keys()) expect(primaryAction(view(at(index), []))).toBeNull();
  });

  it("starts, begins, resumes and completes", () => {
    const typeOf = (current: Current | null, allowed: Allowed) =>
      primaryAction(view(current, [allowed]))?.command.type;
    expect(typeOf(null, "start")).toBe("start");
    expect(typeOf(at(5), "complete_step")).toBe("complete_step");
    expect(typeOf(at(2), "begin_phase")).toBe("begin_phase");
    expect(typeOf(at(2, { status: "paused" }), "resume")).toBe("resume");
  });

  it("names the step it completes, so that a late click does not complete another", () => {
    const action = primaryAction(view(at(5), ["complete_step"]));
    expect(action?.command.step_index).toBe(5);
  });

  it("is never a consent: one press by the experimenter is not the participant's agreement", () => {
    expect(primaryAction(view(at(0), ["complete_step"]))).toBeNull();
  });

  it("leaves the height to its form and answers to the participant", () => {
    expect(primaryAction(view(at(1), ["complete_step"]))).toBeNull();
    expect(primaryAction(view(at(3), ["enter_answers"]))).toBeNull();
  });
});

describe("the start of a phase on the road", () => {
  const preparing = at(0, { status: "preparing" });
  const phases = [
    { phase_id: 1, status: "done" },
    { phase_id: 2, status: "preparing" },
  ];
  const onRoad = view(preparing, [], {
    steps: [{ ...(steps[2] as Step), index: 0, kind: "road_crossing", limb: null }],
    phases: phases as unknown as SessionView["phases"],
  });
  const now = { phase_id: 2, steps: 0, guesses: 0, cars: 0, is_heard: true, waits_for: [] };
  const waits = (scene: Partial<RoadNow> | null) =>
    beforeCrossing(onRoad, {
      has_road: true,
      missing: "",
      now: scene === null ? null : { ...now, is_over: false, problem: "", ...scene },
      runs: [],
    });

  it("says whether it waits for the participant or for the cars, and counts down only then", () => {
    expect(waits(null)).toBe("road.beforeStart");
    // The scene of the phase before is not this one's.
    expect(waits({ phase_id: 1, steps: 900, is_over: true })).toBe("road.beforeStart");
    expect(waits({ waits_for: ["SUMO"] })).toBe("road.beforeCars");
    expect(waits({})).toBe("road.beforeCars");
    expect(waits({ steps: 800, cars: 3 })).toBe("phase.preparing");
  });

  it("does not speak of a countdown before it", () => {
    expect(guidance(onRoad)).toBe("guide.preparing.road");
    expect(guidance(view(at(2, { status: "preparing" }), []))).toBe("guide.preparing");
  });
});

describe("the guidance", () => {
  it("follows the phase while one is running, and the outcome after the end", () => {
    expect(guidance(view(at(2, { status: "walk_back" }), []))).toBe("guide.walk_back");
    expect(guidance(view(at(4), []))).toBe("guide.task.foot");
    expect(guidance(view(null, [], { status: "withdrawn" }))).toBe("guide.withdrawn");
  });

  it("names before the start only the devices that are missing", () => {
    const guideWith = (...connected: readonly string[]) =>
      guidance(
        view(null, [], {
          status: "planned",
          devices: connected.map((kind) => ({ kind, connected: true })) as never,
        }),
      );
    expect(guideWith()).toBe("guide.planned");
    expect(guideWith("tablet")).toBe("guide.planned.headset");
    expect(guideWith("headset")).toBe("guide.planned.tablet");
    expect(guideWith("tablet", "headset")).toBe("guide.planned.connected");
  });
});

describe("a companion who is not seen", () => {
  const appearing = { ...steps[1], kind: "materialise" } as const;
  const road = { ...steps[4], kind: "road_crossing", limb: null } as const;
  const own = { steps: steps.map((one, n) => (n === 1 ? appearing : n === 4 ? road : one)) };
  const because = (index: number | null, inTasks = false) =>
    hiddenBecause(
      view(index === null ? null : at(index), [], own as Partial<SessionView>),
      inTasks,
    );

  it("is hidden for the reason that the step tells", () => {
    expect([because(null), because(0), because(1)]).toEqual(["body", "body", "body"]);
    expect([because(2), because(2, true)]).toEqual(["task", "moment"]);
    expect([because(3), because(4, true)]).toEqual(["moment", "road"]);
  });
});

describe("an action that needs a headset", () => {
  const headset = (connected: boolean) => ({
    id: "h",
    kind: "headset" as const,
    name: "",
    paired_at: "2026-01-01T12:00:00Z",
    connected,
    last_seen_at: null,
    self_test: null,
  });

  it("is marked as such before it is pressed, and no other is", () => {
    for (const type of ["materialise", "begin_phase", "resume"] as const) {
      expect(lacksHeadset(view(at(2), [type]))).toBe(true);
      expect(lacksHeadset(view(at(2), [type], { devices: [headset(false)] }))).toBe(true);
      expect(lacksHeadset(view(at(2), [type], { devices: [headset(true)] }))).toBe(false);
    }
    expect(lacksHeadset(view(at(0), ["complete_step", "skip"]))).toBe(false);
  });

  it("cannot be pressed while none is connected, and a form in the headset waits for it too", () => {
    const blockedWith = (allowed: Allowed, devices: SessionView["devices"]) => {
      const shown = view(at(5), [allowed], { devices });
      const action = primaryAction(shown);
      return action !== null && isBlocked(shown, action);
    };
    expect(blockedWith("materialise", [headset(false)])).toBe(true);
    expect(blockedWith("materialise", [headset(true)])).toBe(false);
    expect(blockedWith("complete_step", [])).toBe(false);
    const inHeadset = steps.map((step) => ({ ...step, forms: "headset" as const }));
    expect(awaitsHeadset(view(at(3), [], { steps: inHeadset }))).toBe(true);
    const devices = [headset(true)];
    expect(awaitsHeadset(view(at(3), [], { steps: inHeadset, devices }))).toBe(false);
    expect(awaitsHeadset(view(at(0), ["complete_step"]))).toBe(false);
  });
});

describe("why a command failed", () => {
  it("is shown only until the session has moved on", () => {
    const sent = { view: view(at(2), []) };
    expect(isOutdated(sent, view(at(2), [], { version: 9 }))).toBe(false);
    expect(isOutdated(sent, view(at(3), []))).toBe(true);
    expect(isOutdated(sent, view(null, [], { status: "completed" }))).toBe(true);
    expect(isOutdated(undefined, session)).toBe(false);
  });
});

describe("what another operator changed", () => {
  const keys = (before: SessionView, after: SessionView) =>
    changesBetween(before, after).map(({ key }) => key);

  it("is described by status, step, phase and notes", () => {
    const running = view(at(2, { status: "running" }), []);
    const paused = view(at(2, { status: "paused" }), []);
    const note = { id: "n", text: "x", at: "2026-01-01T12:00:00Z", by: "admin" };
    expect(keys(running, paused)).toEqual(["change.phase.paused"]);
    expect(keys(running, view(at(3), []))).toEqual(["change.step"]);
    expect(keys(running, { ...running, notes: [note] })).toEqual(["change.notes"]);
    expect(keys(running, view(null, [], { status: "aborted" }))).toEqual(["change.status.aborted"]);
  });

  it("is described also if it was the participant who changed it", () => {
    const refused = { ...session, refusal: { step: 0, at: null } };
    expect(keys(session, refused)).toEqual(["change.refused"]);
    expect(keys(refused, session)).toEqual(["change.retracted"]);
    const alarm = { code: "question_asked" } as SessionView["alarms"][number];
    expect(keys(session, { ...session, alarms: [alarm] })).toEqual(["change.question"]);
  });

  it("is never an empty list", () => {
    expect(keys(session, session)).toEqual(["change.other"]);
  });
});

describe("repeating a step", () => {
  it("proposes the running step, or the task that was just completed", () => {
    expect(redoTarget(view(at(2, { status: "running" }), []))).toBe(2);
    expect(redoTarget(view(at(3), []))).toBe(2);
    expect(redoTarget(view(at(1), []))).toBe(0);
  });

  it("offers no step that is still to come or has not started", () => {
    const offered = (current: Current) => redoable(view(current, [])).map(({ index }) => index);
    expect(offered(at(3))).toEqual([0, 1, 2]);
    expect(offered(at(2, { status: "running" }))).toEqual([0, 1, 2]);
  });

  it("proposes a step that is offered", () => {
    for (const index of [1, 2, 3, 4, 5]) {
      const now = view(at(index), []);
      expect(redoable(now).map((step) => step.index)).toContain(redoTarget(now));
    }
  });
});

describe("the timeline", () => {
  it("groups the steps into before, blocks and after without losing one", () => {
    const groups = groupSteps(steps);
    expect(groups.flatMap((group) => group.steps)).toEqual(steps);
    expect(groups.map(({ number, latency }) => [number, latency])).toEqual([
      [0, null],
      [1, 125],
      [2, 0],
      [0, null],
    ]);
  });
});
