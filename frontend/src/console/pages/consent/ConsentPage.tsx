import type { ConsentRecord } from "@shared/api/records";
import { dateTime } from "@shared/format";
import { type Paragraph, paragraphs } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { Points } from "@shared/ui/Points";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import { consentQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { PaperPage } from "../../ui/PaperPage";
import { useTitle } from "../../ui/page";
import classes from "./ConsentPage.module.css";

export function ConsentPage({ id }: { readonly id: string }): JSX.Element {
  const { t } = useTexts();
  useTitle(t("consent.page"));
  return (
    <PaperPage sessionId={id} back={t("consent.back")} print={t("consent.print")}>
      <Loaded query={useQuery(consentQuery(id))}>
        {(record) =>
          record === null ? (
            <EmptyState icon="document" title={t("consent.none")} isPage>
              {t("consent.none.body")}
            </EmptyState>
          ) : (
            <Sheet record={record} />
          )
        }
      </Loaded>
    </PaperPage>
  );
}

function Sheet({ record }: { readonly record: ConsentRecord }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <article className={classes.sheet}>
      {record.simulated && <p className={classes.simulated}>{t("consent.simulated")}</p>}
      <header>
        <p className={classes.kicker}>{t("consent.page")}</p>
        <h1>{record.study_title}</h1>
      </header>
      {record.erased ? (
        <Notice tone="warn" title={t("consent.erased")}>
          {t("consent.erased.body")} {dateTime(record.at, language)}
        </Notice>
      ) : (
        <>
          {!record.text_matches && (
            <Notice tone="bad" title={t("consent.mismatch")}>
              {t("consent.mismatch.body")}
            </Notice>
          )}
          <section lang={record.language}>
            <h2>{record.title}</h2>
            {paragraphs(record.text).map((paragraph, index) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: the parts of a text have no identifier
              <Part key={index} paragraph={paragraph} />
            ))}
          </section>
          <Statements record={record} />
          <Signature record={record} />
        </>
      )}
      <Facts record={record} />
    </article>
  );
}

function Statements({ record }: { readonly record: ConsentRecord }): JSX.Element | null {
  const { t } = useTexts();
  if (record.statements.length === 0) return null;
  return (
    <section>
      <h2>{t("consent.statements")}</h2>
      <ul className={classes.statements}>
        {record.statements.map((one) => (
          <li key={one.text}>
            <span className={classes.tick}>
              <Icon name={one.ticked === true ? "check" : "minus"} size={18} />
              {t(
                one.ticked === null
                  ? "consent.onPaper"
                  : one.ticked
                    ? "consent.ticked"
                    : "consent.notTicked",
              )}
            </span>
            <span lang={record.language}>{one.text}</span>
          </li>
        ))}
      </ul>
    </section>
  );
}

function Part({ paragraph }: { readonly paragraph: Paragraph }): JSX.Element {
  switch (paragraph.kind) {
    case "heading":
      return <h3>{paragraph.text}</h3>;
    case "prose":
      return <p>{paragraph.text}</p>;
    case "picture":
      // The picture was part of what was signed, so the page to print mentions it.
      return <p>[{paragraph.name}]</p>;
    case "points":
      return <Points points={paragraph.points} />;
  }
}

/** The small print of a record: the facts by which it can be checked against the study later. */
function Facts({ record }: { readonly record: ConsentRecord }): JSX.Element {
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

/** Who signed, and how. */
function Signature({ record }: { readonly record: ConsentRecord }): JSX.Element {
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
