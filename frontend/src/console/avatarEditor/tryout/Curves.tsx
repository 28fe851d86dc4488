/** Angle, error and torque of the watched axis as curves, with what was done to the bodies. */
import { useComputedColorScheme } from "@mantine/core";
import { decimals } from "@shared/format";
import { type JSX, useEffect, useRef } from "react";
import { axisName } from "../../avatarChanges/axes";
import { useTexts } from "../../i18n";
import { MARK_PX, markPath } from "./markShapes";
import type { Mark } from "./marks";
import { type Beside, drawPlot, type Line } from "./plot";
import type { TryoutRun } from "./run";
import classes from "./Tryout.module.css";
import { type Curve, type Trace, WINDOW_TICKS } from "./traces";
import { useFigures } from "./useFigures";
import type { LiveTryout } from "./useTryout";

interface CurvesProps {
  readonly live: LiveTryout;
  readonly axis: string;
  readonly names: readonly string[];
}

const PLOTS = [
  { key: "angles", curves: ["target", "angle"], unit: "°", least: 2 },
  { key: "error", curves: ["error"], unit: "°", least: 0.5 },
  { key: "torque", curves: ["torque"], unit: "N m", least: 1 },
] as const satisfies readonly {
  readonly key: string;
  readonly curves: readonly Curve[];
  readonly unit: string;
  readonly least: number;
}[];
/** Of this body and the other; told apart by the pattern of the line, too. */
const TONES = [
  { token: "--accent", dash: [] },
  { token: "--warn", dash: [7, 4] },
] as const;
const NO_MARKS: readonly Mark[] = [];

/** The curves of the last seconds: narrow, to stand beside the body. */
export function Curves({ live, axis, names }: CurvesProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const title = t("tryout.curves", { axis: axisName(texts, axis) });
  return (
    <section aria-label={title}>
      <h3 className={classes.heading}>
        {title}
        {names.length > 1 && (
          <span className={classes.legend}>
            {names.map((name, row) => (
              <span key={name}>
                <svg width="26" height="8" aria-hidden="true">
                  <line
                    x1="0"
                    x2="26"
                    y1="4"
                    y2="4"
                    stroke={`var(${TONES[row]?.token ?? "--ink"})`}
                    strokeWidth="2"
                    strokeDasharray={TONES[row]?.dash.join(" ")}
                  />
                </svg>
                {name}
              </span>
            ))}
          </span>
        )}
      </h3>
      <div className={classes.plots}>
        {PLOTS.map((plot) => (
          <Plot key={plot.key} live={live} plot={plot} />
        ))}
      </div>
      <MarksLegend run={live.run} />
    </section>
  );
}

function Plot({
  live,
  plot,
}: {
  readonly live: LiveTryout;
  readonly plot: (typeof PLOTS)[number];
}): JSX.Element {
  const { t } = useTexts();
  const canvas = useRef<HTMLCanvasElement>(null);
  const scheme = useComputedColorScheme("light");
  const { run, onPicture } = live;
  useEffect(() => {
    const element = canvas.current;
    if (element === null || run === null || scheme === undefined) return;
    const style = getComputedStyle(element);
    const token = (name: string) => style.getPropertyValue(name).trim();
    const look = {
      ink: token("--ink-soft"),
      grid: token("--line"),
      font: style.fontFamily,
      least: plot.least,
    };
    const draw = () => {
      drawPlot(element, linesOf(run, plot.curves, token), besideOf(run, plot.key, token), look);
    };
    const observer = new ResizeObserver(draw);
    observer.observe(element);
    const forget = onPicture(draw);
    return () => {
      observer.disconnect();
      forget();
    };
  }, [run, onPicture, plot, scheme]);
  return (
    <figure className={classes.plot}>
      <figcaption>
        {`${t(`tryout.curve.${plot.key}`)}, ${plot.unit}`}
        {plot.key === "torque" && <LimitWords run={run} />}
      </figcaption>
      <canvas
        ref={canvas}
        className={classes.curve}
        role="img"
        aria-label={t("tryout.curve.label", { curve: t(`tryout.curve.${plot.key}`) })}
      />
    </figure>
  );
}

const linesOf = (
  run: TryoutRun,
  curves: readonly Curve[],
  token: (name: string) => string,
): readonly Line[] =>
  run.traces.flatMap((trace: Trace, row) =>
    curves.map((curve) => ({
      trace,
      curve,
      colour: curve === "target" ? token("--line-strong") : token(TONES[row]?.token ?? "--ink"),
      dash: curve === "target" ? [2, 3] : (TONES[row]?.dash ?? []),
    })),
  );

/** What is drawn with the curves of a plot. */
const besideOf = (
  run: TryoutRun,
  key: (typeof PLOTS)[number]["key"],
  token: (name: string) => string,
): Beside => ({
  marks: run.marks.since(run.ticks - WINDOW_TICKS),
  ticks: run.ticks,
  hatched: key === "angles" ? [] : run.traces,
  limits:
    key !== "torque"
      ? []
      : run.traces.flatMap(({ limitNm }, row) => {
          const colour = token(TONES[row]?.token ?? "--ink");
          return [limitNm, -limitNm].map((value) => ({ value, colour }));
        }),
});

/** The torque limit, and for how long the motor was at it, in words. */
function LimitWords({ run }: { readonly run: TryoutRun | null }): JSX.Element | null {
  const { t, language } = useTexts();
  const summaries = useFigures(run, ({ traces }) => traces.map(({ summary }) => summary), []);
  const known = summaries.flatMap((one) => (one === null ? [] : [one]));
  if (known.length === 0) return null;
  const each = (of: (one: (typeof known)[number]) => string) => known.map(of).join(" / ");
  const limit = each(({ limitNm }) => decimals(limitNm, language, 0));
  const share = each(({ saturated }) => `${decimals(100 * saturated, language, 0)}\u00a0%`);
  const wasAt = known.some(({ saturated }) => saturated > 0);
  const isNow = known.some(({ isSaturated }) => isSaturated);
  return (
    <>
      {` · ${t("tryout.curve.limit", { limit })}`}
      {/* Always a line of its own: nothing moves when a motor reaches its limit. */}
      <span className={classes.atLimit} data-limited={wasAt}>
        {wasAt
          ? t(isNow ? "tryout.curve.saturated.now" : "tryout.curve.saturated", { share })
          : t("tryout.curve.saturated.never")}
      </span>
    </>
  );
}

/** What was done in the last seconds, with the shapes that mark it. */
function MarksLegend({ run }: { readonly run: TryoutRun | null }): JSX.Element {
  const { t } = useTexts();
  const marks = useFigures(run, (one) => one.marks.since(one.ticks - WINDOW_TICKS), NO_MARKS);
  return (
    <p className={classes.marks}>
      {marks.length === 0 && t("tryout.marks.none")}
      {marks.map(({ id, kind, value }) => (
        <span key={id} data-mark={kind}>
          <svg width={MARK_PX} height={MARK_PX} aria-hidden="true">
            <path
              d={markPath(kind).path}
              fill={markPath(kind).isFilled ? "currentColor" : "none"}
              stroke={markPath(kind).isFilled ? "none" : "currentColor"}
              strokeWidth="1.8"
            />
          </svg>
          {kind === "gravity"
            ? t(value === 1 ? "tryout.mark.gravity.on" : "tryout.mark.gravity.off")
            : t(`tryout.mark.${kind}`, { value: value ?? 0 })}
        </span>
      ))}
    </p>
  );
}
