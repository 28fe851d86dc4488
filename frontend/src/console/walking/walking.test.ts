import { describe, expect, it } from "vitest";
import { changedPath, hasEndsOf, isCompletePath, NO_PATH } from "./drawnPath";
import { furtherOf, isNumberName, numberLabel } from "./furtherNumbers";
import { planOf, ticks, WIDTH } from "./plan";
import { inModelsScene, OPEN_FLOOR } from "./walkedScenes";
import { binned } from "./walkingFigures";

describe("a drawn path", () => {
  const two = [
    { do: "add", point: [0, 0.123] },
    { do: "add", point: [1, 1] },
  ] as const;
  const drawn = two.reduce(changedPath, NO_PATH);

  it("is rounded to centimetres, and can be queried if it has at least two points", () => {
    expect(drawn.points).toEqual([
      [0, 0.12],
      [1, 1],
    ]);
    expect([
      isCompletePath(NO_PATH.points),
      isCompletePath(drawn.points),
      isCompletePath([
        [1, 1],
        [1, 1],
      ]),
    ]).toEqual([false, true, false]);
  });

  it("is undone step by step, without steps that changed nothing", () => {
    const still = changedPath(drawn, { do: "move", at: 1, point: [1.001, 1] });
    expect(still).toBe(drawn);
    const moved = changedPath(drawn, { do: "move", at: 1, point: [2, 1] });
    const fewer = changedPath(moved, { do: "remove", at: 0 });
    expect(fewer.points).toEqual([[2, 1]]);
    const back = changedPath(changedPath(fewer, { do: "undo" }), { do: "undo" });
    expect(back.points).toEqual(drawn.points);
    expect(changedPath(NO_PATH, { do: "undo" })).toBe(NO_PATH);
  });
});

describe("the picture of a scene", () => {
  const plan = planOf([-4, -3, 4, 4]);

  it("has y upwards, one scale, and converts back to the floor", () => {
    expect(plan.y(4)).toBeLessThan(plan.y(-3));
    expect(plan.x(1) - plan.x(0)).toBeCloseTo(plan.y(0) - plan.y(1), 9);
    const [x, y] = plan.floor(plan.x(1.5), plan.y(-2));
    expect([x, y].map((value) => Math.round(value * 1e9) / 1e9)).toEqual([1.5, -2]);
    expect(plan.x(4)).toBeLessThan(WIDTH);
    expect(plan.floor(-100, 10_000)).toEqual([-4, -3]);
  });

  it("has round metres within bounds, both ends included", () => {
    expect(ticks(-2, 1, 60)).toEqual([-2, -1, 0, 1]);
    expect(ticks(0, 1, 400)).toEqual([0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]);
  });
});

describe("the histogram of durations", () => {
  it("counts every walk once, including the slowest", () => {
    const durations = Array.from({ length: 200 }, (_, at) => 2 + (at / 199) ** 2);
    const { edges, counts } = binned(durations);
    expect(counts.reduce((sum, count) => sum + count, 0)).toBe(200);
    expect([edges[0], edges.at(-1)]).toEqual([2, 3]);
  });

  it("supports walks that all take equally long", () => {
    expect(binned([3, 3, 3]).counts[0]).toBe(3);
  });
});

describe("a further number of walks", () => {
  it("is labelled with the words and the unit of its name", () => {
    const names = [
      "load_kg",
      "gaze_on_display",
      "gait_speed_m_s",
      "kg",
      "slope_percent",
      "load_KG",
    ];
    expect(names.map(numberLabel)).toEqual([
      "Load (kg)",
      "Gaze on display",
      "Gait speed (m/s)",
      "Kg",
      "Slope (%)",
      "Load (kg)",
    ]);
  });

  it("has a name of letters, digits and underscores that no other dependency has", () => {
    const names = ["load_kg", "Load2", "2load", "load (kg)", "stature", "Length_m", ""];
    expect(names.filter(isNumberName)).toEqual(["load_kg", "Load2"]);
    expect(furtherOf(["length_m", "stature_m", "load_kg"])).toEqual(["load_kg"]);
  });
});

describe("the scenes of a model's walks", () => {
  const walked = [
    { key: null, walks: 5 },
    { key: OPEN_FLOOR, title: OPEN_FLOOR, walks: 2 },
    { key: "hall", title: "Hall", walks: 3 },
  ];

  it("count walks that name none in the model's scene, or on the open floor", () => {
    expect(inModelsScene(walked, null).map(({ key, walks }) => [key, walks])).toEqual([
      [OPEN_FLOOR, 7],
      ["hall", 3],
    ]);
    expect(inModelsScene(walked, { key: "hall", title: "Hall" })).toEqual([
      { key: "hall", title: "Hall", walks: 8 },
      { key: OPEN_FLOOR, title: OPEN_FLOOR, walks: 2 },
    ]);
  });
});

describe("the ends of a path", () => {
  it("tell whether an answer is about the points that are drawn", () => {
    const line = [
      [0.004, 0],
      [1, 1],
      [2, 0],
    ] as const;
    expect(
      hasEndsOf(line, [
        [0, 0],
        [2, 0],
      ]),
    ).toBe(true);
    expect(
      hasEndsOf(line, [
        [0, 0],
        [2, 1],
      ]),
    ).toBe(false);
    expect(hasEndsOf(line, [])).toBe(false);
  });
});
