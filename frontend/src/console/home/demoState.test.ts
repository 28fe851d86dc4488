import { DEMO_KEY, type Demo } from "@shared/api/housekeeping";
import { describe, expect, it } from "vitest";
import { demoPlace, isThere, studyProgress, whoTookPart } from "./demoState";

const demo = (state: Demo["state"], completed: number): Demo => ({
  state,
  study_key: DEMO_KEY,
  people: 12,
  completed,
  message: null,
  remedy: null,
});
const progress = {
  study_key: DEMO_KEY,
  completed: 0,
  running: 3,
  planned: 12,
  preregistered: false,
};

describe("the demo lab's strip", () => {
  const simulated = { study_key: DEMO_KEY, kind: "simulated" } as const;

  it("stands on the pages of its study and of its simulated sessions", () => {
    expect(demoPlace(`/studies/${DEMO_KEY}`, null)).toBe("overview");
    expect(demoPlace(`/studies/${DEMO_KEY}/dashboard`, null)).toBe("study");
    expect(demoPlace("/sessions/a", simulated)).toBe("session");
    expect(demoPlace("/sessions/a/replay?phase=2", simulated)).toBe("session");
  });

  it("stands neither on other pages nor on a session of a person, in whichever study", () => {
    for (const address of ["/", "/storage", "/studies/mine", `/studies/${DEMO_KEY}-2`]) {
      expect(demoPlace(address, simulated)).toBeNull();
    }
    expect(demoPlace("/sessions/a", { study_key: "mine", kind: "people" })).toBeNull();
    expect(demoPlace("/sessions/a", { study_key: DEMO_KEY, kind: "people" })).toBeNull();
    // Not known yet: nothing is claimed of it.
    expect(demoPlace("/sessions/a", null)).toBeNull();
  });
});

describe("the first page", () => {
  it("tells apart nobody, only simulated people or tests, and people", () => {
    const of = (counts: Record<string, number>) => ({ session_counts: counts });
    expect(whoTookPart([of({ people: 0, simulated: 0, test: 0 })])).toBe("nobody");
    expect(whoTookPart([of({ people: 0 }), of({ people: 0, simulated: 3 })])).toBe("others");
    expect(whoTookPart([of({ people: 1 }), of({ simulated: 3 })])).toBe("people");
  });

  it("counts the demo lab's simulated people, and participants as soon as there are any", () => {
    const study = (people: number) => ({
      key: DEMO_KEY,
      session_counts: { people, simulated: 6, test: 0 },
    });
    expect(studyProgress(study(0), progress, demo("loading", 3))).toEqual({
      of: "demo.finished",
      completed: 3,
      planned: 12,
    });
    expect(studyProgress(study(1), progress, demo("loaded", 12)).of).toBe("home.progress");
    // Somebody else's study with its key, or a reader who may not load it.
    expect(studyProgress(study(0), progress, demo("absent", 0)).of).toBe("home.progress");
    expect(studyProgress(study(0), progress, null).of).toBe("home.progress");
    expect([demo("absent", 0), null, demo("stopped", 1)].map(isThere)).toEqual([
      false,
      false,
      true,
    ]);
  });
});
