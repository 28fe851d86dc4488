/** How long the walk takes: the median and intervals in words, and the distribution. */
import { Figure } from "@charts/Figure";
import { SegmentedControl, Title } from "@mantine/core";
import type { Prediction } from "@shared/api/walking";
import { decimals, number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useMemo, useState } from "react";
import { useTexts } from "../i18n";
import { useDependency } from "./dependencyNames";
import classes from "./Walking.module.css";
import { Synthetic } from "./WalkingTable";
import { type DurationWords, durationFigure } from "./walkingFigures";

interface DurationPanelProps {
  readonly prediction: Prediction;
  readonly busy: boolean;
}

type ChartKind = "histogram" | "ecdf";

export function DurationPanel({ prediction, busy }: DurationPanelProps): JSX.Element {
  const { t, language } = useTexts();
  const [chartKind, setChartKind] = useState<ChartKind>("histogram");
  const words = useDurationWords(prediction.model);
  const figure = useMemo(
    () => durationFigure(prediction, words, chartKind),
    [prediction, words, chartKind],
  );
  const synthetic = prediction.kinds.includes("synthetic");
  const s = (value: number) => decimals(value, language, 1);
  const q = prediction.quantiles_s;
  return (
    <section
      className={`${classes.card} ${busy ? classes.busy : ""}`}
      aria-label={t("walking.duration")}
    >
      <div className={classes.cardHead}>
        <Title order={2} size="h3">
          {t("walking.duration")}
        </Title>
        {synthetic && <Synthetic />}
      </div>
      <div className={classes.answer} role="status">
        <span className={`${classes.median} numbers`}>{t("walking.s", { value: s(q.p50) })}</span>
        <div>
          <div>{t("walking.ninety", { from: s(q.p05), to: s(q.p95) })}</div>
          <div>{t("walking.half", { from: s(q.p25), to: s(q.p75) })}</div>
          <div className={classes.soft}>{t("walking.planFor", { to: s(q.p95) })}</div>
        </div>
      </div>
      <div className={classes.notices}>
        <ExtrapolationNotice prediction={prediction} />
        <NoWalkNotice prediction={prediction} />
      </div>
      <SegmentedControl
        mt="xs"
        size="xs"
        aria-label={t("walking.figure")}
        value={chartKind}
        onChange={(value) => setChartKind(value as ChartKind)}
        data={[
          { value: "histogram", label: t("walking.histogram") },
          { value: "ecdf", label: t("walking.ecdf") },
        ]}
      />
      <Figure
        figure={figure}
        label={t("walking.duration.figure")}
        watermark={synthetic ? t("walking.watermark") : null}
        loading={t("walking.drawing")}
        failed={t("walking.notDrawn")}
      />
      <Summary prediction={prediction} />
    </section>
  );
}

function Summary({ prediction }: { readonly prediction: Prediction }): JSX.Element {
  const { t, language } = useTexts();
  const dependency = useDependency();
  const { count, seed, lost, dependencies, assumed } = prediction;
  return (
    <p className={classes.soft}>
      {t("walking.told", { count: number(count, language), seed, lost })}{" "}
      {prediction.model === "prob" && `${t("walking.prob.told")} `}
      {Object.entries(dependencies)
        .map(([name, value]) =>
          assumed.includes(name)
            ? t("walking.assumed", { what: dependency(name, value) })
            : dependency(name, value),
        )
        .join(" · ")}
    </p>
  );
}

function ExtrapolationNotice({
  prediction,
}: {
  readonly prediction: Prediction;
}): JSX.Element | null {
  const { t } = useTexts();
  const dependency = useDependency();
  if (prediction.outside.length === 0) return null;
  const what = prediction.outside
    .map((name) => dependency(name, prediction.dependencies[name] ?? 0))
    .join(", ");
  return <Notice tone="warn">{t("walking.outside", { what })}</Notice>;
}

/** The paper's models that found no walk on this path: mixed predicts without them. */
function NoWalkNotice({ prediction }: { readonly prediction: Prediction }): JSX.Element | null {
  const { t, language } = useTexts();
  const without = (["stat", "adapt"] as const).filter((name) => prediction[name] === null);
  if (without.length === 0) return null;
  const models = new Intl.ListFormat(language, { type: "conjunction" }).format(without);
  return <Notice tone="warn">{t("walking.noWalk", { count: without.length, models })}</Notice>;
}

function useDurationWords(model: Prediction["model"]): DurationWords {
  const { t, language } = useTexts();
  // Depends on language and model alone: a new table of words at each render would redraw the figure.
  // biome-ignore lint/correctness/useExhaustiveDependencies: `t` follows the language.
  return useMemo(
    () => ({
      time: t("walking.axis.time"),
      walks: t("walking.axis.walks"),
      share: t("walking.axis.share"),
      drawn: t(`walking.${model}`),
      median: t("walking.median"),
      half: t("walking.band.half"),
      ninety: t("walking.band.ninety"),
      stat: t("walking.stat"),
      adapt: t("walking.adapt"),
    }),
    [language, model],
  );
}
