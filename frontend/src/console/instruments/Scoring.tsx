/** How answers become scores: the recoding, then each formula with its range. */
import type { InstrumentPreview } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { EmptyState } from "../ui/EmptyState";
import { ScrollBox } from "../ui/tables";
import classes from "./Instruments.module.css";

export function Scoring({ preview }: { readonly preview: InstrumentPreview }): JSX.Element {
  const { t, language } = useTexts();
  if (preview.scores.length === 0) {
    return (
      <EmptyState icon="chart" title={t("instruments.noScores")}>
        {null}
      </EmptyState>
    );
  }
  return (
    <>
      {preview.recode !== null && (
        <p>
          {t("instrument.recode")} <code className={classes.formula}>{preview.recode}</code>
        </p>
      )}
      <ScrollBox label={t("instruments.scores")} className={classes.scroll}>
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("instruments.scores")}</th>
              <th scope="col">{t("instrument.formula")}</th>
              <th scope="col">{t("instrument.range")}</th>
            </tr>
          </thead>
          <tbody>
            {preview.scores.map((score) => (
              <tr key={score.key}>
                <th scope="row">
                  {inLanguage(score.label, language)}
                  <div className={classes.small}>
                    <code>{score.key}</code>
                    {score.note != null && `: ${score.note}`}
                  </div>
                </th>
                <td className={classes.formula}>{score.formula}</td>
                <td>
                  {score.minimum !== null &&
                    score.maximum !== null &&
                    t("instrument.fromTo", { low: score.minimum, high: score.maximum })}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </ScrollBox>
      <p className={classes.lead}>{t("instrument.missing")}</p>
    </>
  );
}
