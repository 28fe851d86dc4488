import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { Deflection, WATCHED_AFTER_S } from "./physics/deflection";
import { StepWatch, stepFigures } from "./steps";

const FILE = resolve(import.meta.dirname, "../../../../../tests/vectors/avatar/responses.json");

interface Vectors {
  readonly steps: readonly {
    readonly name: string;
    readonly start_rad: number;
    readonly target_rad: number;
    readonly step_s: number;
    readonly angles_rad: readonly number[];
    readonly figures: Readonly<Record<string, number | null>>;
  }[];
  readonly pushes: readonly {
    readonly name: string;
    readonly pushed_ticks: number;
    readonly deflection_rad: readonly number[];
    readonly figures: { readonly peak_rad: number; readonly return_s: number | null };
  }[];
}
const { steps, pushes }: Vectors = JSON.parse(readFileSync(FILE, "utf8"));

const near = (found: number | null, expected: number | null | undefined): void => {
  if (found === null || expected == null) expect(found).toBe(expected);
  else expect(found).toBeCloseTo(expected, 9);
};

describe("the figures of a response are the server's", () => {
  it.each(steps)("for a step that $name", (one) => {
    const angles = Float64Array.from(one.angles_rad);
    const found = stepFigures(angles, one.start_rad, one.target_rad, one.step_s);
    near(found.stepDeg, one.figures.step_deg);
    near(found.overshootPercent, one.figures.overshoot_percent);
    near(found.settlingS, one.figures.settling_s);
    near(found.riseS, one.figures.rise_s);
    near(found.steadyErrorDeg, one.figures.steady_error_deg);
  });

  it.each(pushes)("for a push: $name", (one) => {
    const watch = new Deflection("LeftLowerLeg", Float64Array.of(1, 0, 0, 0));
    one.deflection_rad.forEach((angle, tick) => {
      watch.note(angle, tick < one.pushed_ticks);
    });
    near(watch.figures.peakRad, one.figures.peak_rad);
    near(watch.figures.returnS, one.figures.return_s);
  });
});

describe("a push that is watched", () => {
  it("is measured from where the part was, and for some time after its end", () => {
    const turn = (angle: number) => Float64Array.of(Math.cos(angle / 2), 0, Math.sin(angle / 2), 0);
    const watch = new Deflection("Head", turn(0.5));
    watch.turned(turn(0.2), true);
    expect(watch.figures).toMatchObject({ returnS: null, phase: "pushed" });
    expect(watch.figures.peakRad).toBeCloseTo(0.3, 12);
    watch.turned(turn(0.45), false);
    for (let tick = 1; tick < 100 * WATCHED_AFTER_S; tick++) {
      expect(watch.figures.phase).toBe("watched");
      watch.turned(turn(0.5), false);
    }
    expect(watch.figures).toMatchObject({ phase: "over" });
    expect(watch.figures.returnS).toBeCloseTo(0.01, 12);
    // What comes later is not part of it.
    watch.turned(turn(2), false);
    expect(watch.figures.peakRad).toBeCloseTo(0.3, 12);
  });
});

describe("the steps in a stream of readings", () => {
  const RADIANS = Math.PI / 180;
  const still = (watch: StepWatch, target: number, angle: number, ticks: number) => {
    for (let tick = 0; tick < ticks; tick++) watch.add(target * RADIANS, angle * RADIANS);
  };

  it("begin with a jump of the target from the angle of that moment", () => {
    const watch = new StepWatch();
    still(watch, 0, 1, 50);
    expect(watch.figures).toBeNull();
    still(watch, 40, 30, 10);
    still(watch, 40, 39, 20);
    expect(watch.figures?.stepDeg).toBeCloseTo(39, 9);
    expect(watch.figures?.steadyErrorDeg).toBeCloseTo(1, 9);
    expect(watch.figures?.watchedS).toBeCloseTo(0.3, 9);
    // The next one replaces it only when it has lasted for a second.
    still(watch, 0, 0, 99);
    expect(watch.figures?.stepDeg).toBeCloseTo(39, 9);
    still(watch, 0, 0, 1);
    expect(watch.figures?.stepDeg).toBeCloseTo(-39, 9);
  });

  it("end with a disturbance, are forgotten with a reset, and are not in a movement", () => {
    const watch = new StepWatch();
    still(watch, 0, 0, 5);
    still(watch, 20, 20, 60);
    watch.disturb();
    still(watch, 20, -50, 60);
    expect(watch.figures?.watchedS).toBeCloseTo(0.6, 9);
    watch.forget();
    still(watch, 50, 50, 200);
    expect(watch.figures).toBeNull();
    for (let tick = 0; tick < 300; tick++) watch.add(Math.sin(tick / 30), 0);
    expect(watch.figures).toBeNull();
  });
});
