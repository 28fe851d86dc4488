/**
 * A study's results on one page, to hand on by its address or on paper: how many of those planned,
 * balance, the main test, every effect on one scale, the main figures, and what deviates.
 *
 * It reads what the results' own pages read, so nobody sees here what they may not see there.
 */
import { Anchor, Button, CopyButton, Paper, Title } from "@mantine/core";
import {
  type Dashboard,
  filterFrom,
  type Preregistration,
  type Statistics,
} from "@shared/api/analysis";
import type { DataKind, StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type UseQueryResult, useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { useTexts } from "../../i18n";
import { PrimaryResultBox } from "../../preregistration/AnalysisCard";
import { Primary } from "../../preregistration/DeclarationCard";
import { Deviations } from "../../preregistration/PreregistrationTab";
import { dashboardQuery, preregistrationQuery, statisticsQuery } from "../../queries";
import { sessionCounts } from "../../ui/Counted";
import { useKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { AtAGlance } from "./AtAGlance";
import figures from "./DashboardTab.module.css";
import { FigureCard } from "./FigureCard";
import { MEASURE } from "./StatisticsTab";
import page from "./StudyPage.module.css";
import { SummaryRow } from "./SummaryRow";
import classes from "./SummaryTab.module.css";

/** The figures that are shown: those of what the study is about. */
const MAIN_GROUP = "embodiment";

interface OfStudy {
  readonly study: StudyDetail;
  readonly kind: DataKind;
}

export function SummaryTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t, language } = useTexts();
  const [kind, setKind] = useKind(study.key);
  const filter = { ...filterFrom(new URLSearchParams()), kind };
  const query = useQuery(dashboardQuery(study.key, filter, MAIN_GROUP));
  return (
    <>
      <p className={classes.lead}>{t("summary.lead")}</p>
      <div className={page.toolbar}>
        <KindFilter kind={kind} onChange={setKind} />
        <HandOn study={study} kind={kind} />
      </div>
      <p className={classes.state} aria-live="polite">
        {query.data === undefined
          ? "…"
          : `${sessionCounts(query.data, t)} · ${t("summary.asOf", {
              when: dateTime(query.data.drawn_at, language),
            })}`}
      </p>
      <Loaded query={query}>
        {(dashboard) =>
          dashboard.n_completed - dashboard.n_not_valid === 0 ? (
            <Nobody study={study} kind={kind} excluded={dashboard.n_not_valid} />
          ) : (
            <Summary study={study} kind={kind} dashboard={dashboard} />
          )
        }
      </Loaded>
    </>
  );
}

/** The address with the kind of session in it, so that a link shows what its sender saw. */
function HandOn({ study, kind }: OfStudy): JSX.Element {
  const { t } = useTexts();
  const { origin, pathname } = window.location;
  const link = `${origin}${pathname}?kind=${kind}#/studies/${encodeURIComponent(study.key)}/summary`;
  return (
    <span className={`${page.spacer} ${classes.handOn}`}>
      <CopyButton value={link}>
        {({ copied, copy }) => (
          <Button
            variant="default"
            leftSection={<Icon name={copied ? "check" : "link"} size={17} />}
            onClick={copy}
          >
            {t(copied ? "summary.linked" : "summary.link")}
          </Button>
        )}
      </CopyButton>
      <Button
        variant="default"
        leftSection={<Icon name="document" size={17} />}
        onClick={() => window.print()}
      >
        {t("summary.print")}
      </Button>
    </span>
  );
}

interface NobodyProps extends OfStudy {
  /** How many sessions were completed and do not count. */
  readonly excluded: number;
}

function Nobody({ study, kind, excluded }: NobodyProps): JSX.Element {
  const { t } = useTexts();
  return (
    <EmptyState
      icon="chart"
      title={t(excluded > 0 ? "summary.none" : "dashboard.empty.title")}
      action={
        <Button component={Link} href={`/studies/${study.key}/sessions?kind=${kind}`}>
          {t("study.tab.sessions")}
        </Button>
      }
    >
      {t(excluded > 0 ? "summary.none.body" : "dashboard.empty.body", { count: excluded })}
    </EmptyState>
  );
}

interface SummaryProps extends OfStudy {
  readonly dashboard: Dashboard;
}

function Summary({ study, kind, dashboard }: SummaryProps): JSX.Element {
  const { t } = useTexts();
  const declared = useQuery(preregistrationQuery(study.key, kind));
  const statistics = useQuery(statisticsQuery(study.key, kind));
  // From the top down: what stands below does not move when what is above it arrives.
  const isTestRead = !declared.isPending;
  const areEffectsRead = isTestRead && !statistics.isPending;
  return (
    <div className={classes.page}>
      <SummaryRow study={study} kind={kind} found={dashboard} />
      {dashboard.simulated && (
        <Notice tone="sim" title={t("simulated.title")}>
          {t("simulated.body")}
        </Notice>
      )}
      <Loaded query={declared}>{(view) => <MainTest view={view} />}</Loaded>
      {isTestRead && <Effects study={study} kind={kind} query={statistics} />}
      {areEffectsRead && (
        <>
          <Figures study={study} kind={kind} dashboard={dashboard} />
          {declared.data?.declaration != null && (
            <Deviations deviations={declared.data.deviations} />
          )}
          {statistics.data !== undefined && <LeftOut study={study} found={statistics.data} />}
        </>
      )}
    </div>
  );
}

function Figures({ study, kind, dashboard }: SummaryProps): JSX.Element {
  const { t } = useTexts();
  return (
    <section>
      <div className={classes.titleRow}>
        <Title order={2}>{t("summary.figures")}</Title>
        <Anchor component={Link} href={`/studies/${study.key}/dashboard`}>
          {t("summary.more")}
        </Anchor>
      </div>
      <div className={figures.figures}>
        {dashboard.figures
          .filter(({ figure }) => figure !== null)
          .map((entry) => (
            <FigureCard
              key={entry.key}
              studyKey={study.key}
              entry={entry}
              filter={{ ...filterFrom(new URLSearchParams()), kind }}
              isLazy={false}
            />
          ))}
      </div>
    </section>
  );
}

function MainTest({ view }: { readonly view: Preregistration }): JSX.Element {
  const { t } = useTexts();
  const { declaration, result } = view;
  return (
    <Paper>
      <Title order={2} size="h3" mb="xs">
        {t("summary.test")}
      </Title>
      {declaration === null ? (
        <p className={classes.text}>{t("summary.test.none")}</p>
      ) : result === null ? (
        <Notice tone="info" title={t("prereg.noResult")}>
          {view.why_no_result}
        </Notice>
      ) : (
        <>
          <p className={classes.text}>
            <Primary declaration={declaration} />
          </p>
          <PrimaryResultBox result={result} alpha={declaration.alpha} />
        </>
      )}
    </Paper>
  );
}

interface EffectsProps extends OfStudy {
  readonly query: UseQueryResult<Statistics>;
}

/** Every effect on one scale; a measure leads to its tests. */
function Effects({ study, kind, query }: EffectsProps): JSX.Element {
  const [, navigate] = useLocation();
  return (
    <Loaded query={query}>
      {(found) => (
        <AtAGlance
          measures={found.measures}
          onChoose={(key) =>
            navigate(
              `/studies/${study.key}/statistics?${new URLSearchParams({ kind, [MEASURE]: key })}`,
            )
          }
        />
      )}
    </Loaded>
  );
}

interface LeftOutProps {
  readonly study: StudyDetail;
  readonly found: Statistics;
}

function LeftOut({ study, found }: LeftOutProps): JSX.Element {
  const { t } = useTexts();
  const reasons = [...new Set(found.measures.flatMap(({ left_out }) => left_out))];
  const about = { alpha: found.alpha, study: study.key, version: study.version };
  return (
    <section>
      <Title order={2} size="h3">
        {t("summary.excluded")}
      </Title>
      {reasons.length === 0 ? (
        <p className={classes.text}>{t("statistics.nobody")}</p>
      ) : (
        <ul className={classes.reasons}>
          {reasons.map((reason) => (
            <li key={reason}>{reason}</li>
          ))}
        </ul>
      )}
      <p className={`${classes.text} numbers`}>{t("summary.level", about)}</p>
    </section>
  );
}
