/** A Plotly figure from the server. The library is large, so it is loaded with the first figure. */
import { Center, Loader, Text, useComputedColorScheme } from "@mantine/core";
import { decimalMark } from "@shared/format";
import { type JSX, type RefObject, useEffect, useRef, useState } from "react";
import { heightOf, labelled, type Palette, styled } from "./layout";

interface FigureProps {
  /** The figure as Plotly's JSON: `{data, layout}`. */
  readonly figure: unknown;
  readonly label: string;
  /** Text written across the plot; null for none. */
  readonly watermark: string | null;
  readonly loading: string;
  readonly failed: string;
  /** Draw the figure only when it is scrolled near the window: for pages with many figures. */
  readonly lazy?: boolean;
  /** As high as what it stands in, instead of as high as the server requests. */
  readonly fills?: boolean;
}

/** How far below the window a figure may be when it is drawn. */
const AHEAD = "600px";

type State = "loading" | "drawn" | "failed";

export function Figure({
  figure,
  label,
  watermark,
  lazy = false,
  fills = false,
  ...texts
}: FigureProps): JSX.Element {
  const root = useRef<HTMLElement>(null);
  const scheme = useComputedColorScheme("light");
  const [state, setState] = useState<State>("loading");
  const isNear = useIsNear(root, lazy);
  useEffect(() => {
    const element = root.current;
    if (element === null || !isNear) return;
    // The colours come from the page, so they are read again whenever the colour scheme changes.
    const palette = paletteOf(element, scheme);
    return draw(element, figure, palette, watermark, setState);
  }, [figure, scheme, watermark, isNear]);
  return (
    <div style={{ position: "relative", height: fills ? "100%" : heightOf(figure) }}>
      {state !== "drawn" && (
        <Center pos="absolute" inset={0}>
          {state === "failed" ? (
            <Text c="dimmed">{texts.failed}</Text>
          ) : (
            <Loader role="status" aria-label={texts.loading} />
          )}
        </Center>
      )}
      <section ref={root} aria-label={label} style={{ height: "100%" }} />
    </div>
  );
}

/** Whether an element has come near the window; always true unless `lazy`. */
function useIsNear(root: RefObject<HTMLElement | null>, lazy: boolean): boolean {
  const [isNear, setIsNear] = useState(!lazy);
  useEffect(() => {
    const element = root.current;
    if (element === null || isNear) return;
    const watch = new IntersectionObserver(
      (entries) => {
        if (entries.some((entry) => entry.isIntersecting)) setIsNear(true);
      },
      { rootMargin: AHEAD },
    );
    watch.observe(element);
    // On paper every figure is near.
    const onPrint = () => setIsNear(true);
    window.addEventListener("beforeprint", onPrint);
    return () => {
      watch.disconnect();
      window.removeEventListener("beforeprint", onPrint);
    };
  }, [root, isNear]);
  return isNear;
}

function draw(
  element: HTMLElement,
  figure: unknown,
  palette: Palette,
  watermark: string | null,
  onState: (state: State) => void,
): () => void {
  let cancelled = false;
  let tidy = () => {};
  const { data = [], layout = {} } = figure as {
    data?: unknown[];
    layout?: Record<string, unknown>;
  };
  import("plotly.js-cartesian-dist-min")
    .then(async ({ default: plotly }) => {
      if (cancelled) return;
      await plotly.react(
        element,
        labelled(data, palette),
        {
          separators: separatorsIn(document.documentElement.lang),
          ...styled(layout, palette, watermark),
        },
        CONFIG,
      );
      const observer = new ResizeObserver(() => plotly.Plots.resize(element));
      observer.observe(element);
      tidy = () => {
        observer.disconnect();
        plotly.purge(element);
      };
      if (cancelled) tidy();
      else onState("drawn");
    })
    .catch(() => onState("failed"));
  return () => {
    cancelled = true;
    tidy();
  };
}

/** The marks before decimals and between thousands, as Plotly takes them. */
const separatorsIn = (language: string): string => (decimalMark(language) === "," ? ",." : ".,");

const CONFIG = {
  displaylogo: false,
  responsive: false,
  // The toolbar would cover titles. Dragging zooms in, a double click shows everything again, and
  // pictures are saved with our own buttons, which add the caption and the watermark.
  displayModeBar: false,
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
