import { readdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { CapsuleContacts, segmentBoxDistanceM } from "./contacts";
import type { Laterality, TaskLayout } from "./layout";
import { completionsOf, TaskRun } from "./run";
import {
  type Command,
  type CommandKind,
  type ContactChange,
  type TaskEvent,
  TaskRuleError,
  TaskRules,
  type TaskState,
} from "./state";
import { layoutVectors, readLayouts } from "./testing/layouts";
import type { ContactInterval } from "./tracker";
import { currentGoal, displayedNumbers, surfaceColours } from "./views";

/** The files state one fact each; the README in their folder describes the format. */
const FOLDER = resolve(import.meta.dirname, "../../../../tests/vectors/tasks");

type Row = readonly [number, number, number];
type Pair = readonly [string, string];
interface Input {
  readonly time_s: number;
  readonly command?: CommandKind;
  readonly refused?: boolean;
  readonly begins?: readonly Pair[];
  readonly ends?: readonly Pair[];
}
interface View {
  readonly time_s: number;
  readonly goal: string | null;
  readonly numbers: Readonly<Record<string, number>>;
  readonly green: readonly string[];
  readonly red: readonly string[];
}
interface Interval {
  readonly surface: string;
  readonly part: string;
  readonly begin_s: number;
  readonly end_s: number;
  readonly begin_active_s: number;
  readonly end_active_s: number;
}
interface Run {
  readonly name: string;
  readonly layout: string;
  readonly writing_hand: Laterality;
}
interface RulesVector extends Run {
  readonly kind: "rules";
  readonly inputs: readonly Input[];
  readonly expected: {
    readonly events: readonly object[];
    readonly completions: readonly object[];
    readonly side_red_time_s: Readonly<Record<string, number>>;
    readonly part_side_time_s: readonly (readonly [string, string, number])[];
    readonly intervals?: readonly Interval[];
    readonly views: readonly View[];
  };
}
interface FramesVector extends Run {
  readonly kind: "frames";
  readonly parts: readonly string[];
  readonly radii_m: readonly number[];
  readonly start_s: number;
  readonly freeze_s: number;
  readonly release_margin_m: number;
  readonly frames: readonly { time_s: number; segments_m: readonly (readonly Row[])[] }[];
  readonly expected: { readonly intervals: readonly Interval[] };
}
interface DistancesVector {
  readonly kind: "distances";
  readonly name: string;
  readonly cases: readonly {
    readonly note: string;
    readonly start_m: Row;
    readonly end_m: Row;
    readonly low_m: Row;
    readonly high_m: Row;
    readonly distance_m: number;
  }[];
}
interface TouchesVector {
  readonly kind: "touches";
  readonly name: string;
  readonly layout: string;
  readonly release_margin_m: number;
  readonly cases: readonly {
    readonly note: string;
    readonly parts: readonly { part: string; start_m: Row; end_m: Row; radius_m: number }[];
    readonly touching: readonly Pair[];
    readonly near: readonly Pair[];
  }[];
}
interface LayoutsVector {
  readonly kind: "layouts";
  readonly name: string;
}
type Vector = RulesVector | FramesVector | DistancesVector | TouchesVector | LayoutsVector;
type Kind = Vector["kind"];

const vectors: readonly Vector[] = readdirSync(FOLDER)
  .filter((name) => name.endsWith(".json"))
  .map((name) => ({ name, ...JSON.parse(readFileSync(resolve(FOLDER, name), "utf8")) }));
const ofKind = <K extends Kind>(kind: K) =>
  vectors.filter((vector): vector is Extract<Vector, { kind: K }> => vector.kind === kind);

const layouts = readLayouts();
const layoutOf = (name: string): TaskLayout => layouts.get(name) as TaskLayout;

function stepOf(input: Input): Command | ContactChange {
  const { time_s: timeS, command, begins = [], ends = [] } = input;
  if (command !== undefined) return { timeS, command };
  const contacts = (pairs: readonly Pair[]) => pairs.map(([surface, part]) => ({ surface, part }));
  return { timeS, begins: contacts(begins), ends: contacts(ends) };
}

/** The run of a rules vector, and its state after each input. */
function played(vector: RulesVector): readonly [TaskRun, readonly TaskState[]] {
  const run = new TaskRun(new TaskRules(layoutOf(vector.layout), vector.writing_hand), []);
  const states = vector.inputs.map((input) => {
    if (input.refused) expect(() => run.apply(stepOf(input))).toThrow(TaskRuleError);
    else run.apply(stepOf(input));
    return run.state;
  });
  return [run, states];
}

const eventOf = ({ kind, timeS, activeS, task, surface, part }: TaskEvent) => ({
  time_s: timeS,
  active_s: activeS,
  kind,
  task,
  surface,
  part,
});

const intervalOf = (one: ContactInterval): Interval => ({
  surface: one.surface,
  part: one.part,
  begin_s: one.beginS,
  end_s: one.endS,
  begin_active_s: one.beginActiveS,
  end_active_s: one.endActiveS,
});

const inOrder = (intervals: readonly Interval[]) => {
  const lines = intervals.map((one) => JSON.stringify(Object.values(one)));
  return lines.sort();
};

function grouped<T>(ones: readonly T[], keyOf: (one: T) => string): ReadonlyMap<string, T[]> {
  const groups = new Map<string, T[]>();
  for (const one of ones) groups.set(keyOf(one), [...(groups.get(keyOf(one)) ?? []), one]);
  return groups;
}

/** Active seconds in which at least one of these intervals was there. */
function unitedS(intervals: readonly ContactInterval[]): number {
  const spans = intervals.map((one) => [one.beginActiveS, one.endActiveS] as const);
  let total = 0;
  let until = -Infinity;
  for (const [begin, end] of spans.sort((a, b) => a[0] - b[0])) {
    if (end > until) total += end - Math.max(begin, until);
    until = Math.max(until, end);
  }
  return total;
}

it("every file of the folder has a kind that is tested here", () => {
  const known: readonly string[] = ["layouts", "rules", "distances", "touches", "frames"];
  expect(vectors.length).toBeGreaterThan(30);
  expect(vectors.filter(({ kind }) => !known.includes(kind))).toEqual([]);
});

describe.each(ofKind("rules"))("the rules in $name", (vector) => {
  it("give the events in order, with both times", () => {
    const [run] = played(vector);
    expect(run.events.map(eventOf)).toEqual(vector.expected.events);
  });

  it("give the completions, and the contact times of sides and parts", () => {
    const [run] = played(vector);
    const found = completionsOf(run.events).map((one) => ({
      number: one.number,
      completed_s: one.completedS,
      completed_active_s: one.completedActiveS,
      duration_s: one.durationS,
      order: one.order,
      out_of_order: one.outOfOrder,
      wrong_part: one.wrongPart,
      target_early: one.targetEarly,
    }));
    expect(found).toEqual(vector.expected.completions);
    const { byKey } = run.state.rules.layout;
    const ofSides = run.intervals.filter(({ surface }) => byKey.get(surface)?.kind === "side");
    const unitOf = ({ surface }: ContactInterval) => byKey.get(surface)?.unit as string;
    const units = grouped(ofSides, unitOf);
    const red = [...units].map(([unit, ones]) => [unit, unitedS(ones)]);
    expect(Object.fromEntries(red)).toEqual(vector.expected.side_red_time_s);
    const byPart = grouped(ofSides, (one) => JSON.stringify([unitOf(one), one.part]));
    const times = [...byPart].map(([key, ones]) => [...JSON.parse(key), unitedS(ones)]);
    expect(times.sort()).toEqual([...vector.expected.part_side_time_s].sort());
  });

  it("record the intervals, where the vector lists them", () => {
    const { intervals } = vector.expected;
    if (intervals === undefined) return;
    expect(inOrder(played(vector)[0].intervals.map(intervalOf))).toEqual(inOrder(intervals));
  });

  it("show goal, numbers and colours", () => {
    const [, states] = played(vector);
    for (const view of vector.expected.views) {
      const past = vector.inputs.filter(({ time_s }) => time_s <= view.time_s).length;
      const state = states[past - 1] as TaskState;
      const colours = [...surfaceColours(state)];
      const keys = (colour: string) =>
        colours.filter(([, one]) => one === colour).map(([key]) => key);
      const { targetKey } = state.rules.layout;
      expect(currentGoal(state)).toBe(view.goal);
      expect(Object.fromEntries(displayedNumbers(state))).toEqual(view.numbers);
      expect(
        keys("green")
          .filter((key) => key !== targetKey)
          .sort(),
      ).toEqual([...view.green].sort());
      expect(keys("red").sort()).toEqual([...view.red].sort());
    }
  });
});

it.each(layoutVectors())("the layout %s has the surfaces in order", (name, vector) => {
  const { surfaces } = layoutOf(name);
  const words = ({ key, kind, box, side }: { [name: string]: unknown }) => [key, kind, box, side];
  expect(surfaces.map((one) => words({ ...one }))).toEqual(vector.surfaces.map(words));
  surfaces.forEach(({ centerM, halfSizeM }, index) => {
    const { center_m = [], half_size_m = [] } = vector.surfaces[index] ?? {};
    [...centerM, ...halfSizeM].forEach((value, at) => {
      expect(value).toBeCloseTo([...center_m, ...half_size_m][at] as number, 9);
    });
  });
});

it.each(ofKind("distances").flatMap(({ cases }) => cases))(
  "the distance is exact: $note",
  ({ start_m, end_m, low_m, high_m, distance_m }) => {
    const segment = Float64Array.from([...start_m, ...end_m]);
    const corners = Float64Array.from([...low_m, ...high_m]);
    expect(segmentBoxDistanceM(segment, 0, corners, 0)).toBeCloseTo(distance_m, 12);
  },
);

describe.each(ofKind("touches"))("capsules in $name", ({ cases, layout, release_margin_m }) => {
  it.each(cases)("$note", (one) => {
    const { surfaces } = layoutOf(layout);
    const contacts = new CapsuleContacts(surfaces, one.parts.length);
    contacts.find(
      Float64Array.from(one.parts.flatMap(({ start_m, end_m }) => [...start_m, ...end_m])),
      Float64Array.from(one.parts, ({ radius_m }) => radius_m),
      release_margin_m,
    );
    const pairs = (table: Uint8Array) =>
      surfaces.flatMap(({ key }, surface) =>
        one.parts
          .filter((_, part) => table[surface * one.parts.length + part])
          .map(({ part }) => [key, part]),
      );
    expect(pairs(contacts.touched).sort()).toEqual([...one.touching].sort());
    expect(pairs(contacts.near).sort()).toEqual([...one.near].sort());
  });
});

it.each(ofKind("frames"))("frames give the intervals of $name", (vector) => {
  const layout = layoutOf(vector.layout);
  const run = new TaskRun(new TaskRules(layout, vector.writing_hand), vector.parts);
  const contacts = new CapsuleContacts(layout.surfaces, vector.parts.length);
  run.command("start", vector.start_s);
  for (const { time_s, segments_m } of vector.frames) {
    const segments = Float64Array.from(segments_m.flat(2));
    contacts.find(segments, Float64Array.from(vector.radii_m), vector.release_margin_m);
    run.frame(time_s, contacts);
  }
  run.command("freeze", vector.freeze_s);
  expect(run.intervals.map(intervalOf)).toEqual(vector.expected.intervals);
});
