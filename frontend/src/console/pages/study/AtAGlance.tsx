/** A line for every tested measure and task, with its effect on one scale: what readers look for. */
import { Title } from "@mantine/core";
import type { Effect, Glance, Measure } from "@shared/api/analysis";
import { decimals, number } from "@shared/format";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import table from "../../ui/NumbersTable.module.css";
import classes from "./StatisticsTab.module.css";

interface AtAGlanceProps {
  readonly measures: readonly Measure[];
  readonly onChoose: (key: string) => void;
}

const COLUMNS: Readonly<Record<Glance["factor"], readonly Key[]>> = {
  latency: ["glance.differ", "glance.first", "glance.trend"],
  body: ["glance.differ.bodies", "glance.pairs"],
};
const FACTORS = ["body", "latency"] as const;
const TASKS: Readonly<Record<string, Key>> = {
  hand: "figures.limb.hand",
  foot: "figures.limb.foot",
};

export function AtAGlance({ measures, onChoose }: AtAGlanceProps): JSX.Element | null {
  const { t, language } = useTexts();
  const of = (factor: Glance["factor"]) =>
    measures.filter(({ glance }) => glance[0]?.factor === factor);
  const factors = FACTORS.filter((factor) => of(factor).length > 0);
  if (factors.length === 0) return null;
  return (
    <section className={classes.measure} aria-labelledby="glance">
      <Title order={2} id="glance">
        {t("glance.title")}
      </Title>
      <p className={classes.about}>{t("glance.about")}</p>
      {factors.map((factor) => (
        // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable.
        <div key={factor} className={`${classes.result} ${table.scroll}`} tabIndex={0}>
          <table className={`${table.table} ${classes.glance} numbers`}>
            <thead>
              <tr>
                <th scope="col">{t("glance.measure")}</th>
                <th scope="col">{t("glance.task")}</th>
                <th scope="col" className={classes.effect}>
                  {t("glance.effect", { contrast: contrastOf(of(factor)) })}
                  <span className={`${classes.scale} ${classes.unit}`}>
                    <span>−{number(reachOf(measures), language, 1)}</span>
                    <span>0</span>
                    <span>{number(reachOf(measures), language, 1)}</span>
                  </span>
                </th>
                <th scope="col">{t("glance.difference")}</th>
                {COLUMNS[factor].map((column) => (
                  <th key={column} scope="col">
                    {t(column)}
                  </th>
                ))}
              </tr>
            </thead>
            {of(factor).map((measure) => (
              <Lines
                key={measure.key}
                measure={measure}
                reach={reachOf(measures)}
                onChoose={onChoose}
              />
            ))}
          </table>
        </div>
      ))}
    </section>
  );
}

/** The ends that are compared, which are the same for all measures of a factor. */
const contrastOf = (measures: readonly Measure[]): string =>
  measures.flatMap(({ effects }) => effects)[0]?.contrast ?? "";

/** The end of the scale, standard deviations: every interval fits, in whole steps. */
function reachOf(measures: readonly Measure[]): number {
  const ends = measures
    .flatMap(({ effects }) => effects)
    .flatMap((one) => [one.standardised, one.standardised_low, one.standardised_high])
    .map((end) => Math.abs(end ?? 0));
  return Math.max(1, Math.ceil(Math.max(0, ...ends)));
}

interface LinesProps {
  readonly measure: Measure;
  readonly reach: number;
  readonly onChoose: (key: string) => void;
}

function Lines({ measure, reach, onChoose }: LinesProps): JSX.Element {
  const { t, language } = useTexts();
  const effectOf = (limb: string) => measure.effects.find((one) => one.limb === limb);
  return (
    <tbody>
      {measure.glance.map((line, at) => (
        <tr key={line.limb}>
          {at === 0 && (
            <th scope="rowgroup" rowSpan={measure.glance.length}>
              <button type="button" onClick={() => onChoose(measure.key)}>
                {measure.title}
              </button>
            </th>
          )}
          <td>
            {taskName(line, t)}
            <SampleSize effect={effectOf(line.limb)} />
          </td>
          <td className={classes.effect}>
            <div className={classes.sized}>
              <span>{sizeOf(effectOf(line.limb), language)}</span>
              <EffectMark effect={effectOf(line.limb)} reach={reach} />
            </div>
          </td>
          <td>{differenceOf(effectOf(line.limb), measure.unit, language)}</td>
          <td>{line.differ ?? t("glance.untested")}</td>
          <td>{line.first === "" ? t("glance.none") : (line.first ?? t("glance.untested"))}</td>
          {line.factor === "latency" && <td>{trendOf(line, t)}</td>}
        </tr>
      ))}
    </tbody>
  );
}

const HEIGHT = 24;
const WIDTH = 200;

/** A point with its interval on the common scale; the numbers stand beside it. */
function EffectMark({
  effect,
  reach,
}: {
  readonly effect: Effect | undefined;
  readonly reach: number;
}): JSX.Element | null {
  const size = effect?.standardised ?? null;
  if (effect === undefined || size === null) return null;
  const x = (value: number) => (WIDTH * (value + reach)) / (2 * reach);
  const { standardised_low: low, standardised_high: high } = effect;
  const middle = HEIGHT / 2;
  return (
    <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} preserveAspectRatio="none" aria-hidden="true">
      <line x1={x(0)} x2={x(0)} y1={-4} y2={HEIGHT + 4} className={classes.zero} />
      {low !== null && high !== null && (
        <line
          x1={x(low)}
          x2={x(high)}
          y1={middle}
          y2={middle}
          className={classes.interval}
          vectorEffect="non-scaling-stroke"
        />
      )}
      {/* Ends of lines, which stay round however wide the column is. */}
      {([classes.halo, classes.point] as const).map((look) => (
        <line
          key={look}
          x1={x(size)}
          x2={x(size)}
          y1={middle}
          y2={middle}
          className={look}
          vectorEffect="non-scaling-stroke"
        />
      ))}
    </svg>
  );
}

function SampleSize({ effect }: { readonly effect: Effect | undefined }): JSX.Element | null {
  const { t } = useTexts();
  if (effect === undefined) return null;
  return (
    <>
      {" "}
      <span className={classes.unit}>{t("glance.n", { n: effect.n })}</span>
    </>
  );
}

/** The effect in standard deviations, as a number beside its mark. */
const sizeOf = (effect: Effect | undefined, language: string): string =>
  effect?.standardised == null ? "–" : decimals(effect.standardised, language, 2);

function differenceOf(effect: Effect | undefined, unit: string, language: string): string {
  if (effect === undefined) return "–";
  const text = `${decimals(effect.difference, language, 2)} ${unit}`.trim();
  if (effect.low === null || effect.high === null) return text;
  return `${text} ${intervalOf(effect.low, effect.high, language)}`;
}

/** `[−1.50, 0.25]`; where a comma is the decimal sign, a semicolon stands between the ends. */
export function intervalOf(low: number, high: number, language: string): string {
  const [from, to] = [low, high].map((end) => decimals(end, language, 2));
  return `[${from}${from?.includes(",") ? ";" : ","} ${to}]`;
}

function trendOf({ trend, way }: Glance, t: (key: Key) => string): string {
  if (trend === null) return t("glance.untested");
  return way === null ? trend : `${trend} (${t(`glance.${way}`)})`;
}

function taskName(line: Glance, t: (key: Key) => string): string {
  const key = TASKS[line.limb];
  return key === undefined ? line.limb : t(key);
}
