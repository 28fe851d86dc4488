/** Saves a figure as a picture. */
import { type PictureWords, printed } from "./print";

const PNG_SCALE = 2;

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
