/** Predicted durations and slices of maps as figures, with a unit on every axis. */
import { COLORWAY, type PlotlyFigure } from "@charts/layout";
import type { Prediction, Slice, WalkCensus } from "@shared/api/walking";

export interface DurationWords {
  readonly time: string;
  readonly walks: string;
  readonly share: string;
  readonly drawn: string;
  readonly median: string;
  readonly half: string;
  readonly ninety: string;
  readonly stat: string;
  readonly adapt: string;
}

const [PROB, STAT, ADAPT] = COLORWAY;
const SOFT_BAND = "rgba(14,138,151,0.16)";
const BAND = "rgba(14,138,151,0.3)";
const FEWEST_BINS = 8;
const MAX_BINS = 40;

/**
 * A histogram, or the fraction of walks that have ended by a time; bands contain 50 and 90 % of the
 * walks.
 */
export function durationFigure(
  prediction: Prediction,
  words: DurationWords,
  way: "histogram" | "ecdf",
): PlotlyFigure {
  const { durations_s: durations, quantiles_s: q } = prediction;
  const drawn = way === "histogram" ? histogram(durations, words) : ecdf(durations, words);
  const top = way === "histogram" ? Math.max(...(drawn.y as number[])) * 1.06 : 100;
  const mark = (name: string, at: number, dash: string, color: string | undefined) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: [at, at],
    y: [0, top],
    line: { color, dash, width: 2.2 },
    hovertemplate: `${name}: %{x:.2f} s<extra></extra>`,
  });
  const band = (name: string, from: number, to: number, fillcolor: string) => ({
    type: "scatter",
    mode: "lines",
    name,
    x: [from, from, to, to],
    y: [0, top, top, 0],
    fill: "toself",
    fillcolor,
    line: { width: 0 },
    hoverinfo: "skip",
  });
  return {
    data: [
      band(words.ninety, q.p05, q.p95, SOFT_BAND),
      band(words.half, q.p25, q.p75, BAND),
      drawn,
      mark(words.median, q.p50, "solid", PROB),
      ...fixed(prediction.stat, ({ duration_s }) => mark(words.stat, duration_s, "dot", STAT)),
      ...fixed(prediction.adapt, ({ duration_s }) => mark(words.adapt, duration_s, "dash", ADAPT)),
    ],
    layout: {
      height: 340,
      bargap: 0.04,
      margin: { b: 92 },
      xaxis: { title: { text: words.time, standoff: 6 }, rangemode: "normal" },
      yaxis: {
        title: { text: way === "histogram" ? words.walks : words.share, standoff: 6 },
        range: [0, top],
      },
    },
  };
}

/** What is drawn of a model with one answer; nothing if it found no walk. */
function fixed<Trace>(
  found: Prediction["stat"],
  trace: (found: NonNullable<Prediction["stat"]>) => Trace,
): readonly Trace[] {
  return found === null ? [] : [trace(found)];
}

function ecdf(durations: readonly number[], words: DurationWords) {
  return {
    type: "scatter",
    mode: "lines",
    name: words.drawn,
    x: durations,
    y: durations.map((_, at) => (100 * (at + 1)) / durations.length),
    line: { color: PROB, shape: "hv", width: 2 },
    hovertemplate: "%{y:.0f} % ≤ %{x:.2f} s<extra></extra>",
  };
}

function histogram(durations: readonly number[], words: DurationWords) {
  const { edges, counts } = binned(durations);
  const width = (edges[1] ?? 1) - (edges[0] ?? 0);
  return {
    type: "bar",
    name: words.drawn,
    x: counts.map((_, at) => (edges[at] ?? 0) + width / 2),
    y: counts,
    width,
    marker: { color: PROB, opacity: 0.55 },
    customdata: counts.map((_, at) => [edges[at], edges[at + 1]]),
    hovertemplate: "%{customdata[0]:.2f}–%{customdata[1]:.2f} s: %{y}<extra></extra>",
  };
}

/** Intervals of equal width by the rule of Freedman and Diaconis; the last one is closed. */
export function binned(sorted: readonly number[]): {
  readonly edges: readonly number[];
  readonly counts: readonly number[];
} {
  const low = sorted[0] ?? 0;
  const high = sorted.at(-1) ?? 1;
  const at = (share: number) => sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
  const idealWidth = (2 * (at(0.75) - at(0.25))) / Math.cbrt(Math.max(1, sorted.length));
  const count =
    idealWidth > 0
      ? Math.min(MAX_BINS, Math.max(FEWEST_BINS, Math.ceil((high - low) / idealWidth)))
      : FEWEST_BINS;
  const width = (high - low || 1) / count;
  const counts = new Array<number>(count).fill(0);
  for (const value of sorted) {
    const bin = Math.min(count - 1, Math.floor((value - low) / width));
    counts[bin] = (counts[bin] ?? 0) + 1;
  }
  return { edges: Array.from({ length: count + 1 }, (_, edge) => low + edge * width), counts };
}

interface SliceWords {
  readonly parameter: (name: string, unit: string) => string;
  readonly suitability: string;
  readonly drawn: string;
  readonly stat: string;
  readonly adapt: string;
}

/** A heat map of suitability, overlaid with the parameters that the models choose. */
export function sliceFigure(slice: Slice, prediction: Prediction, words: SliceWords): PlotlyFigure {
  const names = slice.order;
  const [across, along] = [names.indexOf(slice.x.name), names.indexOf(slice.y.name)];
  const mark = (name: string, vectors: readonly (readonly number[])[], symbol: string) => ({
    type: "scatter",
    mode: "markers",
    name,
    x: vectors.map((vector) => vector[across]),
    y: vectors.map((vector) => vector[along]),
    marker: { symbol, size: symbol === "circle" ? 6 : 12, color: "#ffffff", line: OUTLINE },
  });
  return {
    data: [
      {
        type: "heatmap",
        x: slice.x.values,
        y: slice.y.values,
        z: slice.suitability,
        zmin: 0,
        zmax: slice.largest,
        zsmooth: "best",
        colorscale: "Viridis",
        colorbar: { title: { text: words.suitability, side: "right" }, thickness: 14 },
        hovertemplate: "%{x:.2f} · %{y:.2f}: %{z:.3f}<extra></extra>",
      },
      mark(
        words.drawn,
        prediction.walkers.map(({ vector }) => vector),
        "circle",
      ),
      ...fixed(prediction.stat, ({ vector }) => mark(words.stat, [vector], "square")),
      ...fixed(prediction.adapt, ({ vector }) => mark(words.adapt, [vector], "diamond")),
    ],
    layout: {
      height: 360,
      margin: { b: 84 },
      xaxis: {
        title: { text: words.parameter(slice.x.name, slice.x.unit), standoff: 6 },
        range: [slice.x.low, slice.x.high],
      },
      yaxis: {
        title: { text: words.parameter(slice.y.name, slice.y.unit), standoff: 6 },
        range: [slice.y.low, slice.y.high],
      },
    },
  };
}

const OUTLINE = { color: "#1a2424", width: 1.2 };

interface CensusWords {
  readonly length: string;
  readonly count: string;
}

/** How many paths have which length. */
export function censusFigure(census: WalkCensus, words: CensusWords) {
  const { edges_m: edges, counts } = census;
  const width = (edges[1] ?? 0.5) - (edges[0] ?? 0);
  return {
    data: [
      {
        type: "bar",
        x: counts.map((_, at) => (edges[at] ?? 0) + width / 2),
        y: counts,
        width,
        marker: { color: COLORWAY[0], opacity: 0.75 },
        hovertemplate: "%{x:.2f} m: %{y}<extra></extra>",
      },
    ],
    layout: {
      height: 296,
      margin: { b: 62 },
      bargap: 0.06,
      showlegend: false,
      xaxis: { title: { text: words.length, standoff: 6 } },
      yaxis: { title: { text: words.count } },
    },
  };
}
