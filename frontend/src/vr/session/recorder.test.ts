import { describe, expect, it } from "vitest";
import { Recorder } from "./recorder";
import { computedAt, FakeTelemetry } from "./testing";

const RATE_HZ = 90;
const at = (frame: number) => frame / RATE_HZ;
const near = (values: readonly number[]) => values.map((value) => Math.round(value * RATE_HZ));

function recorder() {
  const sink = new FakeTelemetry();
  const onFailure = (error: unknown) => {
    throw error;
  };
  return { sink, made: new Recorder(sink, { withFingers: false, onFailure }) };
}

/** Draw a frame whose bodies are computed at once. */
function draw(made: Recorder, frame: number, phaseId = 0, clockRuns = false): void {
  const shown = computedAt(at(frame));
  made.computed(shown);
  made.frame(at(frame), shown, phaseId, clockRuns);
}

const numbers = (count: number) => Array.from({ length: count }, (_, i) => i);
const MATERIALISED = { kind: "materialised", t_s: 1 } as const;

describe("the recorder", () => {
  it("sends six frames of both streams at a time, and the rest when flushed", () => {
    const { sink, made } = recorder();
    for (const frame of numbers(14)) {
      draw(made, frame);
      made.send(at(frame));
    }
    const sizes = () =>
      sink.sent.map((one) => (one.what === "frames" ? one.frames.timesS.length : 0));
    expect(sizes()).toEqual([6, 6, 6, 6]);
    made.flush(1);
    expect(sizes()).toEqual([6, 6, 6, 6, 2, 2]);
    expect(near(sink.times("target"))).toEqual(numbers(14));
  });

  it("never sends a batch that spans two phases", () => {
    const { sink, made } = recorder();
    for (const frame of numbers(12)) {
      draw(made, frame, frame < 4 ? 0 : 7, frame >= 8);
      made.send(at(frame));
    }
    made.flush(1);
    const batches = sink.sent.flatMap((one) =>
      one.what === "frames" && one.stream === "actual" ? [one.frames] : [],
    );
    expect(batches.map(({ phaseId, timesS }) => [phaseId, timesS.length])).toEqual([
      [0, 4],
      [7, 6],
      [7, 2],
    ]);
    expect(batches.flatMap(({ flags }) => [...flags])).toEqual([
      0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1,
    ]);
  });

  it("sends the frames that led to a report before the report", () => {
    const { sink, made } = recorder();
    for (const frame of numbers(8)) draw(made, frame);
    made.report(MATERIALISED);
    draw(made, 8);
    made.send(1);
    expect(sink.sent.map(({ what }) => what)).toEqual([
      "frames",
      "frames",
      "frames",
      "frames",
      "report",
    ]);
    expect(near(sink.times("target"))).toEqual(numbers(8));
  });

  it("pairs what was shown with the target of the same frame, which a worker computes later", () => {
    const { sink, made } = recorder();
    for (const frame of numbers(13)) {
      // In frame k the participant sees what was computed for frame k - 1.
      const shown = computedAt(at(frame - 1));
      made.computed(shown);
      made.frame(at(frame), shown, 0, false);
      made.send(at(frame));
    }
    expect(near(sink.times("target"))).toEqual(numbers(12));
    expect(near(sink.xs("target"))).toEqual(numbers(12));
    expect(near(sink.xs("actual"))).toEqual(numbers(12).map((frame) => frame - 1));
  });

  it("keeps reports behind the frames whose targets are not known yet", () => {
    const { sink, made } = recorder();
    made.frame(at(1), computedAt(at(0)), 0, false);
    made.report(MATERIALISED);
    made.send(at(1));
    expect(sink.sent).toEqual([]);
    made.computed(computedAt(at(1)));
    made.send(at(2));
    expect(sink.sent.map(({ what }) => what)).toEqual(["frames", "frames", "report"]);
  });

  it("gives a frame that the worker left out a target between its neighbours", () => {
    const { sink, made } = recorder();
    made.computed(computedAt(at(0)));
    for (const frame of [1, 2, 3]) made.frame(at(frame), computedAt(at(0)), 0, false);
    made.computed(computedAt(at(3)));
    made.flush(1);
    expect(near(sink.xs("target"))).toEqual([1, 2, 3]);
  });

  it("sends rows whose targets never come with the last one, when its room is used up", () => {
    const { sink, made } = recorder();
    made.computed(computedAt(at(0)));
    for (const frame of numbers(200)) {
      made.frame(at(frame + 1), computedAt(at(0)), 0, false);
      made.send(at(frame + 1));
    }
    expect(sink.times("target").length).toBeGreaterThanOrEqual(128);
    expect(new Set(near(sink.xs("target")))).toEqual(new Set([0]));
  });
});
