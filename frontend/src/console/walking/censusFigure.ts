/** How many paths are how long. */
import { COLORWAY } from "@charts/layout";
import type { WalkCensus } from "@shared/api/walking";

interface CensusWords {
  readonly length: string;
  readonly count: string;
}

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
