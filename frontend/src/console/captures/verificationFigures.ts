/** The verification as figures, with a unit on every axis. The source is grey and dashed. */
import { COLORWAY, type PlotlyFigure } from "@charts/layout";
import type { Verification, Walker } from "@shared/api/captures";
import { LEFT_COLOUR, RIGHT_COLOUR } from "@shared/stage/figure";

export interface FigureWords {
  readonly left: string;
  readonly right: string;
  readonly time: string;
  readonly hip: string;
  readonly knee: string;
  readonly ankle: string;
  readonly forwardLeft: string;
  readonly forwardRight: string;
  readonly height: string;
  readonly body: (name: string) => string;
  readonly lift: (side: string, from: number, to: number) => string;
}

const SOURCE_COLOUR = "#7d8b8b";
const SIDES = ["left", "right"] as const;
type Side = (typeof SIDES)[number];
const COLOURS: Readonly<Record<Side, string>> = { left: LEFT_COLOUR, right: RIGHT_COLOUR };
const DASHES: Readonly<Record<Side, string>> = { left: "solid", right: "dash" };

/** Figure 8 of the paper: hip, knee and ankle of both legs over time, one above the other. */
export function anglesFigure(verification: Verification, words: FigureWords): PlotlyFigure {
  const joints = [
    { key: "hip_deg", axis: "y", domain: [0.71, 1] },
    { key: "knee_deg", axis: "y2", domain: [0.355, 0.645] },
    { key: "ankle_deg", axis: "y3", domain: [0, 0.29] },
  ] as const;
  const titles = [words.hip, words.knee, words.ankle];
  const data = verification.leg_angles.flatMap((leg) =>
    joints.map(({ key, axis }, index) => ({
      type: "scatter",
      mode: "lines",
      name: words[leg.side],
      legendgroup: leg.side,
      showlegend: index === 0,
      x: verification.times_s,
      y: leg[key],
      yaxis: axis,
      line: { color: COLOURS[leg.side], dash: DASHES[leg.side], width: 1.8 },
    })),
  );
  const axes = joints.map(({ axis, domain }, index) => [
    axis.replace("y", "yaxis"),
    { domain, title: { text: titles[index], standoff: 8 } },
  ]);
  const xaxis = { title: { text: words.time }, anchor: "y3" };
  return { data, layout: { height: 520, xaxis, ...Object.fromEntries(axes) } };
}

/** Figure 9 of the paper: the path of the toe joint, the left foot next to the right. */
export function toeFigure(verification: Verification, words: FigureWords): PlotlyFigure {
  const bodies = [verification.source, ...verification.avatars];
  const data = bodies.flatMap((body, index) =>
    body.toe_paths.map((path) => ({
      type: "scatter",
      mode: "lines",
      name: words.body(body.name),
      legendgroup: body.name,
      showlegend: path.side === "left",
      x: path.forward_m,
      y: path.height_m,
      xaxis: path.side === "left" ? "x" : "x2",
      yaxis: path.side === "left" ? "y" : "y2",
      line: lineOf(index),
    })),
  );
  const layout = {
    height: 380,
    xaxis: { domain: [0, 0.485], title: { text: words.forwardLeft } },
    xaxis2: { domain: [0.515, 1], title: { text: words.forwardRight }, anchor: "y2", matches: "x" },
    yaxis: { title: { text: words.height } },
    yaxis2: { matches: "y", anchor: "x2", showticklabels: false },
  };
  return { data, layout };
}

/** The first line is the source, grey and dashed; the others are avatars. */
const lineOf = (index: number) =>
  index === 0
    ? { color: SOURCE_COLOUR, dash: "dot", width: 2.4 }
    : { color: COLORWAY[(index - 1) % COLORWAY.length], width: 1.8 };

const LANE = 0.17;

/** When each foot is off the ground: a row for each body, the left foot above its line. */
export function liftsFigure(verification: Verification, words: FigureWords): PlotlyFigure {
  const bodies: readonly Walker[] = [verification.source, ...verification.avatars];
  const data = SIDES.map((side) => {
    const lifts = bodies.flatMap((body, row) =>
      body.strides.filter((one) => one.side === side).map((one) => ({ ...one, row })),
    );
    return {
      type: "bar",
      orientation: "h",
      name: words[side],
      base: lifts.map((one) => one.lift_s),
      x: lifts.map((one) => one.contact_s - one.lift_s),
      y: lifts.map(({ row }) => row + (side === "left" ? -LANE : LANE)),
      width: 0.28,
      marker: { color: COLOURS[side], pattern: { shape: side === "left" ? "" : "/" } },
      text: lifts.map((one) => words.lift(words[side], one.lift_s, one.contact_s)),
      textposition: "none",
      hoverinfo: "text",
    };
  });
  const rows = bodies.map((_, row) => row);
  const layout = {
    height: 130 + 44 * bodies.length,
    barmode: "overlay",
    xaxis: { title: { text: words.time }, range: [0, verification.times_s.at(-1) ?? 1] },
    yaxis: {
      tickvals: rows,
      ticktext: bodies.map(({ name }) => words.body(name)),
      range: [bodies.length - 0.45, -0.55],
      zeroline: false,
    },
  };
  return { data, layout };
}
