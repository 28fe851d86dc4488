/** The results of one score in each condition of an import, and how the conditions compare. */
import { Title } from "@mantine/core";
import type { ScoreResult } from "@shared/api/imports";
import { decimals, number } from "@shared/format";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Imports.module.css";

export function ImportedScore({ result }: { readonly result: ScoreResult }): JSX.Element {
  const { t, language } = useTexts();
  const formatted = (value: number | null): string =>
    value === null ? "–" : number(value, language, 2);
  const exact = (value: number | null): string =>
    value === null ? "–" : decimals(value, language, 2);
  return (
    <section className={classes.score} aria-label={result.title}>
      <Title order={4}>{result.title}</Title>
      <div className={classes.tables}>
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("imports.condition")}</th>
              <th scope="col">n</th>
              <th scope="col">{t("imports.mean")}</th>
              <th scope="col">SD</th>
              <th scope="col">{t("imports.interval")}</th>
            </tr>
          </thead>
          <tbody>
            {result.means.map((one) => (
              <tr key={one.condition}>
                <th scope="row">{one.condition || t("imports.noCondition")}</th>
                <td>{one.n}</td>
                <td>{exact(one.mean)}</td>
                <td>{exact(one.sd)}</td>
                <td>{one.low === null ? "–" : `${exact(one.low)} – ${exact(one.high)}`}</td>
              </tr>
            ))}
          </tbody>
        </table>
        {result.pairs.length > 0 && (
          <table className={`${classes.table} numbers`}>
            <thead>
              <tr>
                <th scope="col">{t("imports.pair")}</th>
                <th scope="col">n</th>
                <th scope="col">W</th>
                <th scope="col">p</th>
                <th scope="col">{t("imports.holm")}</th>
                <th scope="col">r</th>
              </tr>
            </thead>
            <tbody>
              {result.pairs.map((one) => (
                <tr key={`${one.a}|${one.b}`}>
                  <th scope="row">
                    {one.a} – {one.b}
                  </th>
                  <td>{one.n}</td>
                  {one.degenerate === null ? (
                    <>
                      <td>{formatted(one.w)}</td>
                      <td>{formatP(one.p)}</td>
                      <td>{formatP(one.p_holm)}</td>
                      <td>{exact(one.rank_biserial)}</td>
                    </>
                  ) : (
                    <td colSpan={4}>{t("imports.degenerate", { n: one.n })}</td>
                  )}
                </tr>
              ))}
            </tbody>
          </table>
        )}
      </div>
      {result.test !== null && <p className={classes.test}>{result.test}</p>}
      {result.pairs.length > 0 && <p className={classes.soft}>{t("imports.method")}</p>}
      {result.left_out.length > 0 && (
        <p className={classes.soft}>
          {t("imports.leftOut", { who: result.left_out.slice(0, 12).join(", ") })}
        </p>
      )}
      {result.why_not !== null && <p className={classes.soft}>{result.why_not}</p>}
    </section>
  );
}

/** A p-value as papers print it: without a zero before the decimal point. */
const formatP = (p: number | null): string =>
  p === null ? "–" : p < 0.001 ? "< .001" : p.toFixed(3).replace(/^0/, "");
