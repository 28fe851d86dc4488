/** The study's questions, answered by tests; nothing here can be filtered. */
import { Title } from "@mantine/core";
import type { Measure, Statistics } from "@shared/api/analysis";
import type { StudyDetail } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { statisticsQuery } from "../../queries";
import { useKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter, sessionCounts } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { AtAGlance } from "./AtAGlance";
import { ResultCard } from "./ResultCard";
import classes from "./StatisticsTab.module.css";
import page from "./StudyPage.module.css";

export function StatisticsTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [kind, setKind] = useKind(study.key);
  const query = useQuery(statisticsQuery(study.key, kind));
  return (
    <>
      <div className={page.toolbar}>
        <KindFilter kind={kind} onChange={setKind} />
        {query.data !== undefined && (
          <span className={page.spacer}>
            {sessionCounts(query.data, t)}
            {!query.data.current && ` · ${t("statistics.computing")}`}
          </span>
        )}
      </div>
      <p className={classes.lead}>{t("statistics.lead")}</p>
      <Loaded query={query}>{(found) => <Answers found={found} />}</Loaded>
    </>
  );
}

function Answers({ found }: { readonly found: Statistics }): JSX.Element {
  const { t } = useTexts();
  const alpha = found.alpha.toString();
  return (
    <>
      {found.simulated && (
        <div className={classes.notice}>
          <Notice tone="sim" title={t("simulated.title")}>
            {t("simulated.body")}
          </Notice>
        </div>
      )}
      <div className={classes.notice}>
        <Notice tone={found.declared ? "info" : "warn"} title={t("statistics.alpha", { alpha })}>
          <ul className={classes.notes}>
            {!found.declared && <li>{t("statistics.undeclared", { alpha })}</li>}
            {found.notes.map((note) => (
              <li key={note}>{note}</li>
            ))}
          </ul>
        </Notice>
      </div>
      {found.measures.length === 0 ? (
        <EmptyState icon="chart" title={t("statistics.empty.title")}>
          {t("statistics.empty.body")}
        </EmptyState>
      ) : (
        <div className={classes.layout}>
          <Contents measures={found.measures} />
          <div>
            <AtAGlance measures={found.measures} onChoose={goTo} />
            {found.measures.map((measure) => (
              <MeasureSection key={measure.key} measure={measure} />
            ))}
          </div>
        </div>
      )}
    </>
  );
}

function Contents({ measures }: { readonly measures: readonly Measure[] }): JSX.Element {
  const { t } = useTexts();
  return (
    <nav className={classes.contents} aria-label={t("statistics.contents")}>
      {measures.map(({ key, title }) => (
        // Buttons rather than links, because the part after # is the page's route.
        <button type="button" key={key} onClick={() => goTo(key)}>
          {title}
        </button>
      ))}
    </nav>
  );
}

const headingOf = (key: string): string => `measure-${key}`;

const goTo = (key: string): void => document.getElementById(headingOf(key))?.scrollIntoView();

function MeasureSection({ measure }: { readonly measure: Measure }): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.measure} aria-labelledby={headingOf(measure.key)}>
      <Title order={2} id={headingOf(measure.key)} className={classes.heading ?? ""}>
        {measure.title}
      </Title>
      <p className={classes.about}>
        {t("statistics.n", { count: measure.n })}
        {measure.about !== "" && ` · ${measure.about}`}
      </p>
      <p className={classes.about}>
        {measure.left_out.length === 0
          ? t("statistics.nobody")
          : `${t("statistics.leftOut")}: ${measure.left_out.join("; ")}.`}
      </p>
      {measure.results.map((result) => (
        <ResultCard key={result.key} result={result} />
      ))}
    </section>
  );
}
