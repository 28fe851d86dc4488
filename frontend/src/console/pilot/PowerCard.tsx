/** The power of the test by number of participants, with everything that it rests on. */
import { Figure } from "@charts/Figure";
import { Paper, Title } from "@mantine/core";
import { decimals, number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { measureWords, primaryWords } from "../preregistration/primaryWords";
import { NumbersTable } from "../ui/tables";
import { isNeverTested, powerFigure } from "./figures";
import { between, interval, listed } from "./intervals";
import { largerThan, lostIn } from "./numbers";
import classes from "./Pilot.module.css";
import type { PowerFigures, PowerPoint } from "./pilots";

export function PowerCard({ power }: { readonly power: PowerFigures }): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const { test, names } = power;
  const never = power.power.filter(isNeverTested).map(({ n }) => n);
  const share = (value: number) => decimals(value, language, 3);
  const target = number(power.target, language, 2);
  const largest = power.power.at(-1);
  const more = largest === undefined ? [] : largerThan(largest.n);
  const lost = lostIn(power.power);
  const ends = power.score_range ?? null;
  return (
    <Paper>
      <Title order={3}>{t("pilot.curve")}</Title>
      <p className={classes.soft}>
        {t(power.preregistered ? "pilot.curve.preregistered" : "pilot.curve.assumed")}:{" "}
        {primaryWords(texts, test, names)}{" "}
        {t("pilot.curve.alpha", { alpha: number(power.alpha, language, 3) })}
      </p>
      <p className={classes.sentence}>
        {power.smallest_sufficient_n !== null &&
          t("pilot.curve.smallest", {
            n: power.smallest_sufficient_n,
            target,
            planned: power.planned_n,
          })}
        {power.smallest_sufficient_n === null && largest !== undefined && (
          <>
            {t("pilot.curve.none", {
              target,
              planned: power.planned_n,
              largest: largest.n,
              power: share(largest.power),
              low: share(largest.low),
              and: between(language),
              high: share(largest.high),
            })}{" "}
            {more.length > 0 && t("pilot.curve.more", { numbers: more.join(", ") })}
          </>
        )}
      </p>
      {never.length > 0 && (
        <Notice tone="warn">{t("pilot.curve.never", { numbers: never.join(", ") })}</Notice>
      )}
      {never.length < power.power.length && (
        <Figure
          figure={powerFigure(power, {
            n: t("pilot.axis.n"),
            share: t("pilot.axis.significant"),
            power: t("pilot.series.power"),
            level: t("pilot.series.level"),
            target: t("pilot.series.target"),
            alpha: t("pilot.series.alpha"),
            language,
          })}
          label={t("pilot.curve")}
          watermark={t("simulated.watermark")}
          loading={t("dashboard.loading")}
          failed={t("dashboard.failed")}
        />
      )}
      <NumbersTable
        label={t("pilot.curve")}
        columns={[
          t("pilot.col.n"),
          t("pilot.col.inTest"),
          t("pilot.col.power"),
          t("pilot.col.level"),
          t("pilot.col.typeS"),
          t("pilot.col.typeM"),
          t("pilot.col.failed"),
        ]}
        rows={power.power.map((one) => cells(one, language))}
      />
      {lost > 0 && <p className={classes.soft}>{t("pilot.curve.lost", { share: lost })}</p>}
      <p className={classes.soft}>
        {t("pilot.curve.note", { sets: number(power.sets, language, 0) })}
      </p>
      <h3 className={classes.small}>{t("pilot.assumed")}</h3>
      <p className={classes.soft}>
        {t("pilot.assumed.difference", {
          difference: number(power.assumed_difference, language, 3),
          measure: measureWords(texts, test, names),
          range:
            ends === null
              ? ""
              : t("pilot.curve.range", {
                  low: number(ends[0], language, 2),
                  high: number(ends[1], language, 2),
                }),
        })}
      </p>
      <NumbersTable
        label={t("pilot.assumed")}
        columns={[
          t("pilot.col.name"),
          t("pilot.col.value"),
          t("pilot.col.unit"),
          t("pilot.col.source"),
        ]}
        rows={power.assumptions.map(({ name, value, unit, source }) => [
          name,
          listed([value].flat(), language, (one) => number(one, language, 6)),
          unit,
          source,
        ])}
      />
      <p className={`${classes.soft} ${classes.hash}`}>SHA-256 {power.assumptions_sha256}</p>
    </Paper>
  );
}

function cells(one: PowerPoint, language: string): readonly string[] {
  const share = (value: number) => decimals(value, language, 3);
  const band = (value: number, low: number, high: number) =>
    isNeverTested(one) ? "–" : `${share(value)} ${interval(share(low), share(high), language)}`;
  const error = (value: number | null) => (value === null ? "–" : decimals(value, language, 2));
  return [
    String(one.n),
    decimals(one.mean_in_test, language, 1),
    band(one.power, one.low, one.high),
    band(one.level, one.level_low, one.level_high),
    error(one.type_s),
    error(one.type_m),
    String(one.failures + one.level_failures),
  ];
}
