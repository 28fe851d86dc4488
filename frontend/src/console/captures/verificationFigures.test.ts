import type { Verification } from "@shared/api/captures";
import { describe, expect, it } from "vitest";
import { anglesFigure, type FigureWords, liftsFigure, toeFigure } from "./verificationFigures";
import { verificationEn } from "./verificationTexts";

const words: FigureWords = {
  left: "left",
  right: "right",
  time: verificationEn["verify.time"],
  hip: verificationEn["verify.angle.hip"],
  knee: verificationEn["verify.angle.knee"],
  ankle: verificationEn["verify.angle.ankle"],
  forwardLeft: verificationEn["verify.toe.forward.left"],
  forwardRight: verificationEn["verify.toe.forward.right"],
  height: verificationEn["verify.toe.height"],
  body: (name) => name,
  lift: (side, from, to) => `${side} ${from} ${to}`,
};

const walker = (name: string, lift_s: number) => ({
  name,
  leg_length_m: 0.8,
  thigh_share: 0.5,
  toe_paths: (["left", "right"] as const).map((side) => ({
    side,
    forward_m: [0, 1],
    height_m: [0, 0.1],
    start_height_m: 0,
  })),
  strides: (["left", "right"] as const).map((side) => ({
    side,
    lift_s,
    contact_s: lift_s + 0.4,
    length_m: 1,
    height_m: 0.1,
    contact_height_m: 0,
  })),
  mean_stride_length_m: 1,
  mean_step_length_m: 0.5,
  mean_step_height_m: 0.1,
  foot_slide_m_s: 0,
});

const verification = {
  frames: 3,
  rate_hz: 1,
  lock_feet: false,
  times_s: [0, 1, 2],
  leg_angles: (["left", "right"] as const).map((side) => ({
    side,
    hip_deg: [1, 2, 3],
    knee_deg: [4, 5, 6],
    ankle_deg: [7, 8, 9],
  })),
  source: walker("source", 0.5),
  avatars: [walker("130cm", 0.6), walker("190cm", 0.7)] as unknown as Verification["avatars"],
  lifts_agree: true,
  largest_timing_difference_s: 0.2,
  unmapped_body_joints: [],
} satisfies Verification;

const titles = ({ layout }: { readonly layout: Readonly<Record<string, unknown>> }) =>
  Object.entries(layout)
    .filter(([name]) => /^[xy]axis/.test(name))
    .flatMap(([, axis]) => (axis as { title?: { text: string } }).title?.text ?? []);

describe("the figures of a verification", () => {
  it("name the unit on every axis that measures something", () => {
    for (const figure of [anglesFigure, toeFigure, liftsFigure]) {
      const named = titles(figure(verification, words));
      expect(named.length).toBeGreaterThan(0);
      for (const title of named) expect(title).toMatch(/\((s|m|deg)\)$/);
    }
  });

  it("draw hip, knee and ankle of each leg separately", () => {
    const { data } = anglesFigure(verification, words);
    expect(data.map(({ name, yaxis, y }) => [name, yaxis, y])).toEqual([
      ["left", "y", [1, 2, 3]],
      ["left", "y2", [4, 5, 6]],
      ["left", "y3", [7, 8, 9]],
      ["right", "y", [1, 2, 3]],
      ["right", "y2", [4, 5, 6]],
      ["right", "y3", [7, 8, 9]],
    ]);
    expect(data.map(({ showlegend }) => showlegend)).toEqual([1, 0, 0, 1, 0, 0].map(Boolean));
  });

  it("draw the toes of every body on the same scale, with the source dashed", () => {
    const { data, layout } = toeFigure(verification, words);
    expect(data).toHaveLength(6);
    expect(data.filter(({ showlegend }) => showlegend).map(({ name }) => name)).toEqual([
      "source",
      "130cm",
      "190cm",
    ]);
    expect(data[0]).toMatchObject({ line: { dash: "dot" } });
    expect(new Set(data.map(({ line }) => (line as { color: string }).color)).size).toBe(3);
    expect(layout).toMatchObject({ xaxis2: { matches: "x" }, yaxis2: { matches: "y" } });
  });

  it("draw each lift from leaving the ground to the contact, the left foot above the right", () => {
    const { data } = liftsFigure(verification, words);
    const [left, right] = data as unknown as { base: number[]; x: number[]; y: number[] }[];
    expect(left?.base).toEqual([0.5, 0.6, 0.7]);
    for (const length of left?.x ?? []) expect(length).toBeCloseTo(0.4, 12);
    // The y axis is reversed: smaller values are drawn further up.
    for (const [row, y] of (left?.y ?? []).entries()) {
      expect(y).toBeLessThan(row);
      expect(right?.y[row]).toBeGreaterThan(row);
    }
  });
});
