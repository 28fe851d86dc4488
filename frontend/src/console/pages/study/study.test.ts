import type { Ledger, Slot, StudyDetail } from "@shared/api/types";
import { describe, expect, it } from "vitest";
import { offsetOfLine, place } from "../Problems";
import { filesOf } from "./archiveFiles";
import { arrange, nextFree } from "./LedgerTab";
import { orderCount } from "./orderCount";

const ORDERS = [
  [0, 125],
  [125, 0],
];

const slot = (index: number, order: number, replicate: number, state: Slot["state"]): Slot => ({
  index,
  block: replicate - 1,
  replicate,
  sequence: ORDERS[order] ?? [],
  state,
  attempts: [],
});

const ledger: Ledger = {
  kind: "people",
  seed: 1,
  when_full: "grow",
  started: true,
  sequences: ORDERS.map((sequence) => ({ sequence, completed: 0, open: 0, total: 2 })),
  slots: [
    slot(0, 1, 1, "completed"),
    slot(1, 0, 1, "open"),
    slot(2, 0, 2, "free"),
    slot(3, 1, 2, "free"),
  ],
};

describe("what an archive can contain", () => {
  const study = (crossing: object | undefined) =>
    ({ protocol: { procedure: { block: { crossing } } } }) as unknown as StudyDetail;

  it("has the files of a road only for a study with a crossing, or one that is not told", () => {
    const asked = [study({ crossings: 2 }), study(undefined), { protocol: null }];
    expect(asked.map((one) => filesOf(one).includes("road"))).toEqual([true, false, true]);
    expect(filesOf(study(undefined))).toEqual(expect.arrayContaining(["trackers", "companions"]));
  });
});

describe("the ledger as a grid", () => {
  it("has every slot in the row of its order and the column of its replicate", () => {
    const grid = arrange(ledger);
    expect(grid?.columns).toEqual([1, 2]);
    expect(grid?.rows.map((row) => row.slots.map((cell) => cell?.index))).toEqual([
      [1, 2],
      [0, 3],
    ]);
  });

  it("tells orders of the same latencies apart by their bodies", () => {
    const bodies = [
      ["female", null],
      [null, "female"],
    ];
    const rows = bodies.map((own) => ({ sequence: [0, 0], bodies: own }));
    const grid = arrange({
      ...ledger,
      sequences: rows.map((row) => ({ ...row, completed: 0, open: 0, total: 1 })),
      slots: rows.map((row, at) => ({ ...slot(at, 0, 1, "free"), ...row })),
    });
    expect(grid?.rows.map((row) => row.slots.map((cell) => cell?.index))).toEqual([[0], [1]]);
  });

  it("is null if the orders are hidden or nothing is drawn yet", () => {
    expect(arrange({ ...ledger, sequences: null })).toBeNull();
    expect(arrange({ ...ledger, slots: [] })).toBeNull();
  });

  it("knows the slot that is assigned next", () => {
    expect(nextFree(ledger.slots)).toBe(2);
    expect(nextFree(ledger.slots.slice(0, 2))).toBeNull();
  });
});

describe("the orders of a design", () => {
  const orders = { replicates: 1, seed: 1, when_full: "grow" };

  it("are n! permutations, n or 2n rows of a Williams design, or those listed", () => {
    const counts = (design: string) =>
      [1, 2, 3, 4].map((n) => orderCount({ ...orders, design }, n));
    expect(counts("all_permutations")).toEqual([1, 2, 6, 24]);
    expect(counts("williams")).toEqual([1, 2, 6, 4]);
    const sequences = [["a", "b"]];
    expect(orderCount({ ...orders, design: "explicit", sequences }, 2)).toBe(1);
  });
});

describe("problems of a study file", () => {
  it("give their position as path:line:column", () => {
    const problem = { path: "orders.replicates", line: 12, column: 15, message: "too few" };
    expect(place(problem)).toBe("orders.replicates:12:15");
    expect(place({ path: "", line: 3, column: null, message: "x" })).toBe("3");
  });

  it("lead to their line in the text", () => {
    expect(offsetOfLine("key: a\ntitle: b\nx: 1", 2)).toEqual([7, 15]);
  });
});
