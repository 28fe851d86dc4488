/** A line for every tested measure and task: what readers look for first. */
import { Title } from "@mantine/core";
import type { Glance, Measure } from "@shared/api/analysis";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import table from "../../ui/NumbersTable.module.css";
import classes from "./StatisticsTab.module.css";

interface AtAGlanceProps {
  readonly measures: readonly Measure[];
  readonly onChoose: (key: string) => void;
}

const COLUMNS: Readonly<Record<Glance["factor"], readonly Key[]>> = {
  latency: ["glance.measure", "glance.task", "glance.differ", "glance.first", "glance.trend"],
  body: ["glance.measure", "glance.task", "glance.differ.bodies", "glance.pairs"],
};
const FACTORS = ["body", "latency"] as const;
const TASKS: Readonly<Record<string, Key>> = {
  hand: "figures.limb.hand",
  foot: "figures.limb.foot",
};

export function AtAGlance({ measures, onChoose }: AtAGlanceProps): JSX.Element | null {
  const { t } = useTexts();
  const of = (factor: Glance["factor"]) =>
    measures.filter(({ glance }) => glance[0]?.factor === factor);
  const factors = FACTORS.filter((factor) => of(factor).length > 0);
  if (factors.length === 0) return null;
  return (
    <section className={classes.measure} aria-labelledby="glance">
      <Title order={2} id="glance" className={classes.heading ?? ""}>
        {t("glance.title")}
      </Title>
      <p className={classes.about}>{t("glance.about")}</p>
      {factors.map((factor) => (
        // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable.
        <div key={factor} className={`${classes.result} ${table.scroll}`} tabIndex={0}>
          <table className={`${table.table} ${classes.glance} numbers`}>
            <thead>
              <tr>
                {COLUMNS[factor].map((column) => (
                  <th key={column} scope="col">
                    {t(column)}
                  </th>
                ))}
              </tr>
            </thead>
            {of(factor).map((measure) => (
              <Lines key={measure.key} measure={measure} onChoose={onChoose} />
            ))}
          </table>
        </div>
      ))}
    </section>
  );
}

interface LinesProps {
  readonly measure: Measure;
  readonly onChoose: (key: string) => void;
}

function Lines({ measure, onChoose }: LinesProps): JSX.Element {
  const { t } = useTexts();
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
          <td>{taskName(line, t)}</td>
          <td>{line.differ ?? t("glance.untested")}</td>
          <td>{line.first === "" ? t("glance.none") : (line.first ?? t("glance.untested"))}</td>
          {line.factor === "latency" && <td>{trendOf(line, t)}</td>}
        </tr>
      ))}
    </tbody>
  );
}

function trendOf({ trend, way }: Glance, t: (key: Key) => string): string {
  if (trend === null) return t("glance.untested");
  return way === null ? trend : `${t(`glance.${way}`)}, ${trend}`;
}

function taskName(line: Glance, t: (key: Key) => string): string {
  const key = TASKS[line.limb];
  return key === undefined ? line.limb : t(key);
}
