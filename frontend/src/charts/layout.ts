/** How a figure from the server is styled for this page; its content stays unchanged. */

/** A figure as Plotly's JSON. */
export interface PlotlyFigure {
  readonly data: readonly Readonly<Record<string, unknown>>[];
  readonly layout: Readonly<Record<string, unknown>>;
}

/** The page's colours for a figure. */
export interface Palette {
  readonly ink: string;
  readonly soft: string;
  readonly line: string;
  readonly sim: string;
  readonly font: string;
}

/** Okabe and Ito's colours, distinguishable with any kind of colour vision; petrol comes first. */
export const COLORWAY = ["#0e8a97", "#d55e00", "#8067c9", "#c78500", "#3f8f4f", "#b0527f"] as const;

/** Below the plot and its axes: the edge of the figure is the only place that is always free. */
const LEGEND = { orientation: "h", x: 0, y: 0, yref: "container", yanchor: "bottom" } as const;

const USUAL_HEIGHT_PX = 380;

/** The height that the server requests for a figure of many parts, or the usual one. */
export function heightOf(figure: unknown): number {
  const layout = isObject(figure) && isObject(figure.layout) ? figure.layout : {};
  return typeof layout.height === "number" ? layout.height : USUAL_HEIGHT_PX;
}

type Layout = Readonly<Record<string, unknown>>;

const isObject = (value: unknown): value is Layout =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** The server's layout in the page's colours, on every axis, with the watermark if there is one. */
export function styled(layout: Layout, palette: Palette, watermark: string | null): Layout {
  const { template: _template, title: _title, height: _height, ...rest } = layout;
  return {
    colorway: COLORWAY,
    ...rest,
    autosize: true,
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    margin: { l: 56, r: 12, t: 16, b: 48, ...(isObject(rest.margin) ? rest.margin : {}) },
    font: { family: palette.font, size: 13, color: palette.ink },
    legend: LEGEND,
    ...axes(rest, palette),
    annotations: [
      ...annotationsOf(rest),
      ...(watermark === null ? [] : [watermarkOf(watermark, palette)]),
    ],
  };
}

/**
 * The server's traces with their direct labels in the page's ink: a line's own colour, which is
 * chosen for lines on any ground, is too faint for small letters on a dark one.
 */
export const labelled = (
  data: readonly unknown[],
  palette: Pick<Palette, "ink">,
): readonly unknown[] =>
  data.map((trace) =>
    isObject(trace) && isObject(trace.textfont)
      ? { ...trace, textfont: { ...trace.textfont, color: palette.ink } }
      : trace,
  );

function axes(layout: Layout, palette: Palette): Layout {
  const names = new Set([
    "xaxis",
    "yaxis",
    ...Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key)),
  ]);
  return Object.fromEntries(
    [...names].map((name) => {
      const axis = layout[name];
      const axisLayout = isObject(axis) ? axis : {};
      return [
        name,
        {
          automargin: true,
          ...axisLayout,
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

/** A watermark across the plot, so that a copied picture still shows what its data are. */
function watermarkOf(text: string, palette: Palette): Layout {
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
