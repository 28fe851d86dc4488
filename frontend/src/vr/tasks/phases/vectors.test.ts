import { readdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import type { PhaseOrder, ReportBody } from "../../telemetry";
import type { Touches } from "../contacts";
import type { Laterality, TaskLayout } from "../layout";
import { TaskRules } from "../state";
import { readLayouts } from "../testing/layouts";
import { BoxRun } from "./boxRun";
import { FreeRun, type TimedRun } from "./timedRun";

/** The scripted headset made these files; the README in their folder describes the format. */
const FOLDER = resolve(import.meta.dirname, "../../../../../tests/vectors/phases");

type Pair = readonly [string, string];
interface Step {
  readonly t_s: number;
  readonly touched?: readonly Pair[];
  readonly near?: readonly Pair[];
  readonly connected?: boolean;
  readonly order?: Partial<PhaseOrder>;
  readonly restart?: Partial<PhaseOrder>;
  readonly reports?: readonly ReportBody[];
}
interface PhaseVector {
  readonly name: string;
  readonly kind: string;
  readonly fact: string;
  readonly layout: string | null;
  readonly writing_hand: Laterality;
  readonly parts: readonly string[];
  readonly order: PhaseOrder;
  readonly steps: readonly Step[];
}

const vectors: readonly PhaseVector[] = readdirSync(FOLDER)
  .filter((name) => name.endsWith(".json"))
  .map((name) => ({ name, ...JSON.parse(readFileSync(resolve(FOLDER, name), "utf8")) }));
const layouts = readLayouts();

function runOf(vector: PhaseVector, order: PhaseOrder, timeS: number): TimedRun {
  if (vector.layout === null) return new FreeRun(order, timeS);
  const layout = layouts.get(vector.layout) as TaskLayout;
  return new BoxRun(order, new TaskRules(layout, vector.writing_hand), vector.parts, timeS);
}

function touchesOf(vector: PhaseVector, { touched = [], near = [] }: Step): Touches {
  const surfaces = layouts.get(vector.layout ?? "")?.surfaces ?? [];
  const table = (pairs: readonly Pair[]) =>
    Uint8Array.from(
      surfaces.flatMap(({ key }) =>
        vector.parts.map((part) => Number(pairs.some((one) => one[0] === key && one[1] === part))),
      ),
    );
  return { touched: table(touched), near: table([...touched, ...near]) };
}

describe("a phase of the vectors", () => {
  it("is of a kind that is tested here", () => {
    expect(vectors.length).toBeGreaterThan(10);
    expect(vectors.filter(({ kind }) => kind !== "phase")).toEqual([]);
  });

  it.each(vectors)("makes the reports of the scripted headset: $name", (vector) => {
    let run = runOf(vector, vector.order, 0);
    for (const step of vector.steps) {
      const { t_s: timeS, order, restart, reports = [], connected = true } = step;
      if (restart !== undefined) run = runOf(vector, { ...vector.order, ...restart }, timeS);
      else if (order !== undefined) {
        expect(run.follow({ ...vector.order, ...order }, timeS), `at ${timeS} s`).toEqual(reports);
      } else {
        const found = run.frame(timeS, touchesOf(vector, step), connected);
        expect(found, `at ${timeS} s`).toEqual(reports);
      }
    }
    expect(run.hasEnded).toBe(true);
  });
});
