/** A Plotly figure of the server. The library is large, so it is fetched when the first is shown. */
import { Center, Loader, Text, useComputedColorScheme } from "@mantine/core";
import { type JSX, useEffect, useRef, useState } from "react";
import { dressed, heightOf, type Palette } from "./layout";

interface FigureProps {
  /** The figure as Plotly's JSON: `{data, layout}`. */
  readonly figure: unknown;
  readonly label: string;
  /** Written across the plot; null leaves it clean. */
  readonly watermark: string | null;
  readonly loading: string;
  readonly failed: string;
}

type State = "loading" | "drawn" | "failed";

export function Figure({ figure, label, watermark, ...texts }: FigureProps): JSX.Element {
  const root = useRef<HTMLElement>(null);
  const scheme = useComputedColorScheme("light");
  const [state, setState] = useState<State>("loading");
  useEffect(() => {
    const element = root.current;
    if (element === null) return;
    // Read again whenever the appearance changes: the colours are the page's own.
    const palette = paletteOf(element, scheme);
    return draw(element, figure, palette, watermark, setState);
  }, [figure, scheme, watermark]);
  return (
    <div style={{ position: "relative", height: heightOf(figure) }}>
      {state !== "drawn" && (
        <Center pos="absolute" inset={0}>
          {state === "failed" ? (
            <Text c="dimmed">{texts.failed}</Text>
          ) : (
            <Loader aria-label={texts.loading} />
          )}
        </Center>
      )}
      <section ref={root} aria-label={label} style={{ height: "100%" }} />
    </div>
  );
}

function draw(
  element: HTMLElement,
  figure: unknown,
  palette: Palette,
  watermark: string | null,
  onState: (state: State) => void,
): () => void {
  let gone = false;
  let tidy = () => {};
  const { data = [], layout = {} } = figure as {
    data?: unknown[];
    layout?: Record<string, unknown>;
  };
  import("plotly.js-cartesian-dist-min")
    .then(async ({ default: plotly }) => {
      if (gone) return;
      await plotly.react(element, data, dressed(layout, palette, watermark), CONFIG);
      const observer = new ResizeObserver(() => plotly.Plots.resize(element));
      observer.observe(element);
      tidy = () => {
        observer.disconnect();
        plotly.purge(element);
      };
      if (gone) tidy();
      else onState("drawn");
    })
    .catch(() => onState("failed"));
  return () => {
    gone = true;
    tidy();
  };
}

const CONFIG = {
  displaylogo: false,
  responsive: false,
  modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"],
} as const;

function paletteOf(element: HTMLElement, scheme: "light" | "dark"): Palette {
  const style = getComputedStyle(element);
  const token = (name: string, light: string, dark: string): string =>
    style.getPropertyValue(name).trim() || (scheme === "light" ? light : dark);
  return {
    ink: token("--ink", "#1a2424", "#e6eded"),
    soft: token("--ink-soft", "#52605f", "#a3b3b3"),
    line: token("--line", "#dbe2e2", "#2c3737"),
    sim: token("--sim", "#5a3fa0", "#bba8f2"),
    font: style.fontFamily,
  };
}
