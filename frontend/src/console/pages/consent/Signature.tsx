/** Who signed, and how. */
import type { ConsentRecord } from "@shared/api/records";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./ConsentPage.module.css";

export function Signature({ record }: { readonly record: ConsentRecord }): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.signature}>
      <h2>{t("consent.signature")}</h2>
      {record.signature !== null && (
        <svg
          className={classes.drawn}
          viewBox="0 0 600 200"
          role="img"
          aria-label={t("consent.drawn")}
        >
          <path d={record.signature} />
        </svg>
      )}
      {record.name !== null && (
        <p className={classes.name}>
          <span>{t("consent.name")}</span>
          {record.name}
        </p>
      )}
      {record.paper !== null && <Paper paper={record.paper} />}
      {record.mode === "operator" && <p>{t("consent.spoken")}</p>}
      {record.mode === "tablet" && record.signature_wanted === "none" && (
        <p>{t("consent.unsigned")}</p>
      )}
    </section>
  );
}

function Paper({ paper }: { readonly paper: NonNullable<ConsentRecord["paper"]> }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <p className={classes.name}>{t("consent.paper")}</p>
      <p>
        {t("consent.paper.place")}: {paper.place}
      </p>
      <p>
        {t("consent.paper.reason")}: {paper.reason}
      </p>
    </>
  );
}
