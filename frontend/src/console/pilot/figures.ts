/** The curves of a pilot as figures: what Plotly draws. */
import type { CohortFigures, PowerFigures, PowerPoint } from "./pilots";

const HEIGHT = 300;
/** Distinguishable with any kind of colour vision, and by their dashes and marks. */
const POWER = "#3a7fd0";
const LEVEL = "#d55e00";
const GREY = "#8a9898";
const DASHES = ["solid", "dash", "dot"] as const;
const HUES = [POWER, LEVEL] as const;

export interface PowerWords {
  readonly n: string;
  readonly share: string;
  readonly power: string;
  readonly level: string;
  readonly target: string;
  readonly alpha: string;
  readonly language: string;
}

/** Whether the test could be computed on no data set, so that 0 would be no finding. */
export const isNeverTested = (one: PowerPoint): boolean =>
  one.failures === one.sets && one.level_failures === one.sets;

/** Power with its band by number of participants, the level with its own, target and alpha. */
export function powerFigure(curve: PowerFigures, words: PowerWords): object {
  const points = curve.power.filter((one) => !isNeverTested(one));
  const n = points.map((one) => one.n);
  const ends = [Math.min(...n, curve.planned_n), Math.max(...n, curve.planned_n)];
  return {
    data: [
      share(
        n,
        points.map((one) => [one.power, one.low, one.high]),
        words.power,
        POWER,
        "solid",
      ),
      share(
        n,
        points.map((one) => [one.level, one.level_low, one.level_high]),
        words.level,
        LEVEL,
        "dash",
      ),
      flat(ends, curve.target, words.target, "dot"),
      flat(ends, curve.alpha, words.alpha, "dashdot"),
    ],
    layout: layout(words, words.n, [0, 1.02]),
  };
}

export interface LatencyWords {
  readonly latency: string;
  readonly share: string;
  readonly published: string;
  readonly limb: (limb: string) => string;
  readonly language: string;
}

/** Completions by latency as a share of those at the lowest, beside the published curve. */
export function latencyFigure(figures: CohortFigures, words: LatencyWords): object {
  const limbs = [...new Set(figures.phases.map(({ limb }) => limb))];
  return {
    data: [
      ...limbs.map((limb, at) => {
        const own = figures.phases.filter(
          (one) => one.limb === limb && one.share_of_lowest !== null,
        );
        return {
          type: "scatter",
          mode: "lines+markers",
          x: own.map((one) => one.latency_ms),
          y: own.map((one) => 100 * (one.share_of_lowest ?? 0)),
          name: words.limb(limb),
          line: { color: HUES[at % HUES.length], width: 2, dash: DASHES[at % DASHES.length] },
          ...intervals(own, HUES[at % HUES.length] ?? POWER),
        };
      }),
      {
        type: "scatter",
        mode: "lines+markers",
        x: figures.published.map((one) => one.end_to_end_ms),
        y: figures.published.map((one) => one.performance_percent),
        name: words.published,
        line: { color: GREY, width: 1, dash: "dot" },
        marker: { symbol: "diamond" },
      },
    ],
    layout: layout(words, words.latency),
  };
}

/** The intervals of the means where there are any: not of one person, nor where all are alike. */
const intervals = (phases: CohortFigures["phases"], color: string): object => {
  const ends = phases.map((phase) => {
    const at = phase.share_of_lowest ?? 0;
    return hasInterval(phase)
      ? ([(phase.share_high ?? at) - at, at - (phase.share_low ?? at)] as const)
      : ([0, 0] as const);
  });
  return phases.some(hasInterval)
    ? {
        error_y: {
          type: "data",
          symmetric: false,
          array: ends.map(([above]) => 100 * above),
          arrayminus: ends.map(([, below]) => 100 * below),
          color,
        },
      }
    : {};
};

/** Whether the mean of a phase has an interval that says how far it can be trusted. */
export const hasInterval = ({
  share_low,
  share_high,
}: Pick<CohortFigures["phases"][number], "share_low" | "share_high">): boolean =>
  share_low != null && share_high != null && share_low < share_high;

/** How many people the means are of: one number, or the fewest and the most. */
export function peopleIn(phases: CohortFigures["phases"]): string {
  const counts = phases.map(({ people }) => people);
  const [fewest, most] = [Math.min(...counts), Math.max(...counts)];
  return fewest === most ? String(most) : `${fewest}–${most}`;
}

type Band = readonly [value: number, low: number, high: number];

const share = (
  x: readonly number[],
  bands: readonly Band[],
  name: string,
  color: string,
  dash: string,
) => ({
  type: "scatter",
  mode: "lines+markers",
  x,
  y: bands.map(([value]) => value),
  name,
  line: { color, width: 2, dash },
  error_y: {
    type: "data",
    symmetric: false,
    array: bands.map(([value, , high]) => high - value),
    arrayminus: bands.map(([value, low]) => value - low),
    color,
  },
});

const flat = (x: readonly number[], at: number, name: string, dash: string) => ({
  type: "scatter",
  mode: "lines",
  x,
  y: x.map(() => at),
  name,
  line: { color: GREY, width: 1, dash },
});

interface AxisWords {
  readonly share: string;
  readonly language: string;
}

const layout = ({ share: y, language }: AxisWords, x: string, range?: readonly number[]) => ({
  height: HEIGHT,
  // The decimal sign, then the one between thousands.
  separators: language === "de" ? ",." : ".,",
  xaxis: { title: { text: x } },
  yaxis: { title: { text: y }, rangemode: "tozero", ...(range === undefined ? {} : { range }) },
  legend: { orientation: "h", y: 1.25 },
  margin: { l: 60, r: 20, t: 30, b: 48 },
});
