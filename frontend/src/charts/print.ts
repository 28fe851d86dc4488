/**
 * A figure as a picture for a paper: black on white, with its title above and its caption below.
 */
import { heightOf, type Palette, styled } from "./layout";

interface PictureWords {
  readonly title: string;
  readonly caption: string;
  readonly watermark: string | null;
}

interface Printed {
  readonly layout: Readonly<Record<string, unknown>>;
  readonly width: number;
  readonly height: number;
}

const PAPER: Palette = {
  ink: "#111111",
  soft: "#333333",
  line: "#d0d0d0",
  sim: "#5a3fa0",
  font: "Arial, Helvetica, sans-serif",
};
const NARROW_PX = 1000;
const WIDE_PX = 1400;
const TITLE_PX = 46;
const CAPTION_LINE_PX = 17;
const CAPTION_FONT_PX = 12;
const MARGIN_PX = 24;
const LEGEND_PX = 36;
const LEGEND_GAP_PX = 8;
/** Characters per pixel of width in a line of the caption, in the caption's font. */
const CHARACTERS_PER_PX = 1 / 6.2;

export function printed(figure: unknown, words: PictureWords, wide: boolean): Printed {
  const { layout = {} } = figure as { layout?: Readonly<Record<string, unknown>> };
  const width = wide ? WIDE_PX : NARROW_PX;
  const lines = wrapped(words.caption, Math.floor((width - 2 * MARGIN_PX) * CHARACTERS_PER_PX));
  const below = lines.length * CAPTION_LINE_PX + MARGIN_PX;
  const plot = Math.max(heightOf(figure), 460);
  const height = TITLE_PX + plot + below;
  const dress = styled(layout, PAPER, words.watermark);
  const margin = (dress.margin ?? {}) as Readonly<Record<string, number>>;
  const top = (margin.t ?? 16) + TITLE_PX;
  const bottom = Math.max(margin.b ?? 48, 48 + LEGEND_PX) + below;
  return {
    width,
    height,
    layout: {
      ...dress,
      autosize: false,
      width,
      height,
      paper_bgcolor: "#ffffff",
      plot_bgcolor: "#ffffff",
      margin: { ...margin, t: top, b: bottom, l: Math.max(margin.l ?? 0, 64), r: 32 },
      legend: { ...(dress.legend as object), y: (below + LEGEND_GAP_PX) / height },
      title: {
        text: escaped(words.title),
        x: 0,
        xref: "container",
        pad: { l: MARGIN_PX },
        y: 1 - MARGIN_PX / height,
        yref: "container",
        font: { size: 17 },
      },
      annotations: [
        ...(dress.annotations as readonly unknown[]),
        {
          text: lines.map(escaped).join("<br>"),
          xref: "paper",
          yref: "paper",
          x: 0,
          xanchor: "left",
          xshift: -40,
          y: 0,
          yanchor: "top",
          yshift: -(bottom - below) - 6,
          align: "left",
          showarrow: false,
          font: { size: CAPTION_FONT_PX, color: PAPER.soft },
        },
      ],
    },
  };
}

/** Break a text into lines of at most `most` characters; a longer word gets a line of its own. */
export function wrapped(text: string, most: number): readonly string[] {
  const lines: string[] = [];
  for (const word of text.split(/\s+/).filter((one) => one !== "")) {
    const last = lines.at(-1);
    if (last !== undefined && last.length + 1 + word.length <= most) {
      lines[lines.length - 1] = `${last} ${word}`;
    } else lines.push(word);
  }
  return lines;
}

/** Escape the HTML that Plotly interprets in texts. */
const escaped = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

const PNG_SCALE = 2;

/** Save a figure as a picture. */
export async function savePicture(
  figure: unknown,
  words: PictureWords,
  wide: boolean,
  format: "png" | "svg",
  filename: string,
): Promise<void> {
  const { default: plotly } = await import("plotly.js-cartesian-dist-min");
  const { layout, width, height } = printed(figure, words, wide);
  const { data = [] } = figure as { data?: unknown[] };
  const scale = format === "png" ? PNG_SCALE : 1;
  await plotly.downloadImage({ data, layout }, { format, width, height, scale, filename });
}
