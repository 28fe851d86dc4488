import { DEMO_KEY } from "@shared/api/housekeeping";
import { describe, expect, it } from "vitest";
import { studyToTry } from "./studyToTry";

const listed = (...keys: string[]) => keys.map((key) => ({ key }));

describe("The study that is tried", () => {
  const studies = listed("first", "own", "reembodiment-latency");

  it("is the open one, else the one that the sidebar shows, else the shipped one", () => {
    expect(studyToTry("/studies/first/protocol", studies, "own")?.key).toBe("first");
    expect(studyToTry("/", studies, "own")?.key).toBe("own");
    expect(studyToTry("/", studies, "deleted")?.key).toBe("reembodiment-latency");
    expect(studyToTry("/", listed("first", "own"), null)?.key).toBe("first");
    expect(studyToTry("/studies/gone", listed("another"), null)?.key).toBe("another");
    expect(studyToTry("/", [], "own")).toBeNull();
  });

  it("is never the demo lab's, whose figures are of its own people", () => {
    const demo = listed(DEMO_KEY, ...studies.map(({ key }) => key));
    expect(studyToTry("/", demo, DEMO_KEY)?.key).toBe("reembodiment-latency");
    expect(studyToTry(`/studies/${DEMO_KEY}/dashboard`, demo, null)?.key).toBe(
      "reembodiment-latency",
    );
    expect(studyToTry("/", listed(DEMO_KEY), DEMO_KEY)).toBeNull();
  });
});
