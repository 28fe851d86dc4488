/** The curves of a tuned axis as figures: what Plotly draws. */
import type { AxisCurves } from "./tunings";

export interface CurveWords {
  readonly time: string;
  readonly angle: string;
  readonly torque: string;
  readonly target: string;
  readonly before: string;
  readonly after: string;
}

const HEIGHT = 240;
/** Distinguishable with any kind of colour vision, and by their dashes. */
const BEFORE = { color: "#d55e00", width: 2, dash: "dash" } as const;
const AFTER = { color: "#3a7fd0", width: 2 } as const;
const TARGET = { color: "#8a9898", width: 1, dash: "dot" } as const;

/** A step of the target with the gains before and after, over time. */
export function stepFigure({ before, after }: AxisCurves, words: CurveWords): object {
  const span = [0, Math.max(after.time_s.at(-1) ?? 1, before.time_s.at(-1) ?? 1)];
  return {
    data: [
      line(span, [after.target_deg, after.target_deg], words.target, TARGET),
      line(before.time_s, before.angle_deg, words.before, BEFORE),
      line(after.time_s, after.angle_deg, words.after, AFTER),
    ],
    layout: layout(words.time, words.angle),
  };
}

/** The torque of the motor in the same steps. */
export function torqueFigure({ before, after }: AxisCurves, words: CurveWords): object {
  return {
    data: [
      line(before.time_s, before.torque_nm, words.before, BEFORE),
      line(after.time_s, after.torque_nm, words.after, AFTER),
    ],
    layout: layout(words.time, words.torque),
  };
}

/** The oscillation that the relay made; null if there was none. */
export function relayFigure({ relay }: AxisCurves, words: CurveWords): object | null {
  if (relay == null) return null;
  return {
    data: [
      line(relay.time_s, relay.angle_deg, words.angle, AFTER),
      { ...line(relay.time_s, relay.torque_nm, words.torque, TARGET), yaxis: "y2" },
    ],
    layout: {
      ...layout(words.time, words.angle),
      yaxis2: { title: { text: words.torque }, overlaying: "y", side: "right", showgrid: false },
    },
  };
}

const line = (x: readonly number[], y: readonly number[], name: string, style: object) => ({
  type: "scatter",
  mode: "lines",
  x,
  y,
  name,
  line: style,
});

const layout = (x: string, y: string) => ({
  height: HEIGHT,
  xaxis: { title: { text: x } },
  yaxis: { title: { text: y } },
  legend: { orientation: "h", y: 1.2 },
  margin: { l: 56, r: 56, t: 30, b: 44 },
});
