/** How a figure of the server looks on this page: its content unchanged, its dress ours. */
export interface Palette {
  readonly ink: string;
  readonly soft: string;
  readonly line: string;
  readonly sim: string;
  readonly font: string;
}

/** Okabe and Ito's colours, told apart with any kind of colour vision; petrol leads. */
export const COLORWAY = ["#0e8a97", "#d55e00", "#8067c9", "#c78500", "#3f8f4f", "#b0527f"] as const;

/** Below the plot and its axes: the edge of the figure is the only place that is always free. */
const LEGEND = { orientation: "h", x: 0, y: 0, yref: "container", yanchor: "bottom" } as const;

const USUAL_HEIGHT_PX = 380;

/** The height the server asks for, because a figure of many parts needs more of it. */
export function heightOf(figure: unknown): number {
  const layout = isObject(figure) && isObject(figure.layout) ? figure.layout : {};
  return typeof layout.height === "number" ? layout.height : USUAL_HEIGHT_PX;
}

type Layout = Readonly<Record<string, unknown>>;

const isObject = (value: unknown): value is Layout =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** The server's layout with the page's colours, every axis included, and the mark of a simulation. */
export function dressed(layout: Layout, palette: Palette, watermark: string | null): Layout {
  const { template: _template, title: _title, height: _height, ...kept } = layout;
  return {
    colorway: COLORWAY,
    ...kept,
    autosize: true,
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    margin: { l: 56, r: 12, t: 16, b: 48, ...(isObject(kept.margin) ? kept.margin : {}) },
    font: { family: palette.font, size: 13, color: palette.ink },
    legend: LEGEND,
    ...axes(kept, palette),
    annotations: [
      ...annotationsOf(kept),
      ...(watermark === null ? [] : [mark(watermark, palette)]),
    ],
  };
}

function axes(layout: Layout, palette: Palette): Layout {
  const names = new Set([
    "xaxis",
    "yaxis",
    ...Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key)),
  ]);
  return Object.fromEntries(
    [...names].map((name) => {
      const axis = layout[name];
      const given = isObject(axis) ? axis : {};
      return [
        name,
        {
          automargin: true,
          ...given,
          gridcolor: palette.line,
          linecolor: palette.soft,
          zerolinecolor: palette.soft,
          tickcolor: palette.soft,
        },
      ];
    }),
  );
}

const annotationsOf = (layout: Layout): readonly unknown[] =>
  Array.isArray(layout.annotations) ? layout.annotations : [];

/** Written across the plot, so that a copied picture still says what its data are. */
function mark(text: string, palette: Palette): Layout {
  return {
    text,
    xref: "paper",
    yref: "paper",
    x: 0.5,
    y: 0.5,
    showarrow: false,
    textangle: -18,
    opacity: 0.22,
    font: { size: 40, color: palette.sim },
  };
}
