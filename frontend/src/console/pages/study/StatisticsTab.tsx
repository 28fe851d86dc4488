/** The study's questions, answered by tests; nothing here can be filtered. */
import { Button, Title } from "@mantine/core";
import type { Measure, Statistics } from "@shared/api/analysis";
import type { StudyDetail } from "@shared/api/types";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect } from "react";
import { useSearch } from "wouter";
import { useTexts } from "../../i18n";
import { statisticsQuery } from "../../queries";
import { Counted } from "../../ui/Counted";
import { useKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { AtAGlance } from "./AtAGlance";
import { CopyButton, ResultCard } from "./ResultCard";
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
        <Counted
          found={query.data}
          doing={query.data?.current === false ? t("statistics.computing") : null}
        />
      </div>
      <p className={classes.lead}>{t("statistics.lead")}</p>
      <Loaded query={query}>{(found) => <Answers found={found} />}</Loaded>
    </>
  );
}

function Answers({ found }: { readonly found: Statistics }): JSX.Element {
  const { t, language } = useTexts();
  const alpha = number(found.alpha, language, 4);
  useOpenInPrint();
  useOpenFromAddress();
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
        <>
          <AtAGlance measures={found.measures} onChoose={open} />
          <div className={classes.tools}>
            <Title order={2} className={classes.toolsTitle ?? ""}>
              {t("statistics.measures")}
            </Title>
            <CopyButton
              text={found.measures.flatMap(apaLines).join("\n")}
              label={t("statistics.copyAll")}
            />
            <Button size="compact-xs" variant="subtle" onClick={() => setEvery(true)}>
              {t("statistics.expand")}
            </Button>
            <Button size="compact-xs" variant="subtle" onClick={() => setEvery(false)}>
              {t("statistics.collapse")}
            </Button>
          </div>
          {found.measures.map((measure) => (
            <MeasureCard key={measure.key} measure={measure} />
          ))}
        </>
      )}
    </>
  );
}

/** What names a measure in the address. */
export const MEASURE = "measure";

const idOf = (key: string): string => `measure-${key}`;

const apaLines = ({ results }: Measure): readonly string[] =>
  results.map(({ apa }) => apa).filter((apa) => apa !== "");

/** Open a measure's card and go to it. */
function open(key: string): void {
  const card = document.getElementById(idOf(key));
  if (!(card instanceof HTMLDetailsElement)) return;
  card.open = true;
  card.scrollIntoView();
  card.querySelector("summary")?.focus({ preventScroll: true });
}

/** A link to one measure, as the summary has for each: its card is open when the page is. */
function useOpenFromAddress(): void {
  const measure = new URLSearchParams(useSearch()).get(MEASURE);
  useEffect(() => {
    if (measure !== null) open(measure);
  }, [measure]);
}

function setEvery(opened: boolean): void {
  for (const card of document.querySelectorAll<HTMLDetailsElement>(`.${classes.card}`)) {
    card.open = opened;
  }
}

/** On paper nothing is behind a click: what was collapsed is opened, and closed again afterwards. */
function useOpenInPrint(): void {
  useEffect(() => {
    let opened: HTMLDetailsElement[] = [];
    const before = () => {
      opened = [...document.querySelectorAll<HTMLDetailsElement>("main details:not([open])")];
      for (const card of opened) card.open = true;
    };
    const after = () => {
      for (const card of opened) card.open = false;
      opened = [];
    };
    window.addEventListener("beforeprint", before);
    window.addEventListener("afterprint", after);
    return () => {
      window.removeEventListener("beforeprint", before);
      window.removeEventListener("afterprint", after);
    };
  }, []);
}

function MeasureCard({ measure }: { readonly measure: Measure }): JSX.Element {
  const { t } = useTexts();
  return (
    <details id={idOf(measure.key)} className={classes.card}>
      <summary className={classes.summary}>
        <Icon name="forward" size={16} />
        <Title order={3} size="h4">
          {measure.title}
        </Title>
        <span className={classes.brief}>
          {t("statistics.n", { count: measure.n })}
          {` · ${t("statistics.results", { count: measure.results.length })}`}
        </span>
      </summary>
      <div className={classes.inside}>
        {measure.about !== "" && <p className={classes.about}>{measure.about}</p>}
        <p className={classes.about}>
          {measure.left_out.length === 0
            ? t("statistics.nobody")
            : `${t("statistics.leftOut")}: ${measure.left_out.join("; ")}.`}
        </p>
        {measure.results.map((result) => (
          <ResultCard key={result.key} result={result} />
        ))}
      </div>
    </details>
  );
}
