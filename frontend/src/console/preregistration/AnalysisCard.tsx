/** The analysis: who is included, who is excluded by which rule, and the test as declared. */
import { Paper, Title } from "@mantine/core";
import type { Preregistration, PrimaryResult } from "@shared/api/analysis";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { NumbersTable } from "../ui/tables";
import classes from "./Preregistration.module.css";

interface AnalysisCardProps {
  readonly view: Preregistration;
  readonly alpha: number;
}

export function AnalysisCard({ view, alpha }: AnalysisCardProps): JSX.Element {
  const { t } = useTexts();
  const planned = view.declaration?.planned_n ?? 0;
  return (
    <Paper>
      <Title order={2} size="h3">
        {t("prereg.done")}
      </Title>
      <p className={classes.count}>
        {t("prereg.included", { count: view.included, planned })}
        <span>{t("prereg.sessions", { count: view.sessions })}</span>
      </p>
      {view.result === null ? (
        <Notice tone="info" title={t("prereg.noResult")}>
          {view.why_no_result}
        </Notice>
      ) : (
        <PrimaryResultBox result={view.result} alpha={alpha} />
      )}
      <h3 className={classes.small}>{t("prereg.excluded", { count: view.excluded.length })}</h3>
      {view.excluded.length === 0 ? (
        <p className={classes.soft}>{t("prereg.excluded.none")}</p>
      ) : (
        <ul className={classes.plain}>
          {view.excluded.map((one) => (
            <li key={`${one.participant_code} ${one.rule}`}>
              <strong>{one.participant_code}</strong> <code>{one.rule}</code>: {one.reason}
            </li>
          ))}
        </ul>
      )}
    </Paper>
  );
}

interface PrimaryResultBoxProps {
  readonly result: PrimaryResult;
  readonly alpha: number;
}

/** The preregistered test: its sentence, how p compares with the declared level, its numbers. */
export function PrimaryResultBox({ result, alpha }: PrimaryResultBoxProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.result}>
      <p className={classes.sentence}>{result.sentence}</p>
      <p className={classes.soft}>
        {t(result.holds ? "prereg.atMost" : "prereg.exceeds", { alpha })} {result.method}
      </p>
      <NumbersTable
        label={t("prereg.numbers")}
        columns={result.columns}
        rows={result.rows}
        className={classes.numbers}
      />
    </div>
  );
}
