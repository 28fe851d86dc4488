/** The small print of a record: what makes it possible to check it against the study later. */
import type { ConsentRecord } from "@shared/api/records";
import { dateTime } from "@shared/format";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import classes from "./ConsentPage.module.css";

export function Facts({ record }: { readonly record: ConsentRecord }): JSX.Element {
  const { t, language } = useTexts();
  const facts: readonly (readonly [Key, string])[] = [
    ["consent.at", `${dateTime(record.at, language)} (${record.at})`],
    [
      "consent.by",
      record.mode === "tablet" ? t("consent.tablet") : record.by.replace("account:", ""),
    ],
    ["consent.participant", record.participant_code],
    ["consent.session", record.session_id],
    ["consent.study", record.study_key],
    ["consent.version", String(record.study_version)],
    ["consent.hash", record.content_hash],
    ["consent.textHash", record.text_hash],
    ["consent.language", record.language],
  ];
  return (
    <footer className={classes.facts}>
      <dl>
        {facts
          .filter(([, value]) => value !== "")
          .map(([key, value]) => (
            <div key={key}>
              <dt>{t(key)}</dt>
              <dd>{value}</dd>
            </div>
          ))}
      </dl>
      {record.records > 1 && <p>{t("consent.earlier", { count: record.records - 1 })}</p>}
    </footer>
  );
}
