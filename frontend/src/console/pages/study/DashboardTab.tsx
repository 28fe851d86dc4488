/**
 * The study's figures, drawn by the server from the selected sessions of one kind.
 *
 * The groups are requested one after the other, from the top, so the first is shown early.
 */
import { Title } from "@mantine/core";
import {
  type Dashboard,
  type FigureGroup,
  type Filter,
  filterFrom,
  searchOf,
} from "@shared/api/analysis";
import type { StudyDetail } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useLocation, useSearch } from "wouter";
import { useTexts } from "../../i18n";
import { dashboardQuery } from "../../queries";
import { Counted } from "../../ui/Counted";
import { kindOf, useOwnSearch, useRememberedKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import classes from "./DashboardTab.module.css";
import { FigureCard } from "./FigureCard";
import { FilterBar } from "./FilterBar";
import page from "./StudyPage.module.css";
import { SummaryRow } from "./SummaryRow";

/** What the study is about comes first; the summary row above says how far it is. */
const FIRST = "embodiment";
const AFTERWARDS = ["tasks", "movement", "answers", "demographics", "progress", "quality"] as const;

export function DashboardTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [filter, setFilter] = useFilter(study.key);
  const query = useQuery(dashboardQuery(study.key, filter, FIRST));
  return (
    <>
      <div className={`${page.toolbar} ${classes.selection}`}>
        <KindFilter
          kind={filter.kind}
          onChange={(kind) => setFilter({ ...filterFrom(new URLSearchParams()), kind })}
        />
        {filter.kind === "simulated" && (
          <div className={classes.simulated}>
            <Notice tone="sim" title={t("simulated.title")} compact>
              {t("simulated.body")}
            </Notice>
          </div>
        )}
        <Counted
          found={query.data}
          doing={query.data?.current === false ? t("dashboard.drawing") : null}
        />
      </div>
      <Loaded query={query}>
        {(dashboard) => (
          <>
            <SummaryRow study={study} kind={filter.kind} counts={dashboard} />
            <FilterBar filter={filter} choices={dashboard.choices} onChange={setFilter} />
            {dashboard.filter.rows === "all" && (
              <div className={classes.banner}>
                <Notice tone="warn" title={t("figures.all")}>
                  {t("figures.all.body")}
                </Notice>
              </div>
            )}
            <Groups studyKey={study.key} filter={filter} groups={[FIRST, ...AFTERWARDS]} enabled />
          </>
        )}
      </Loaded>
    </>
  );
}

interface GroupsProps {
  readonly studyKey: string;
  readonly filter: Filter;
  readonly groups: readonly FigureGroup[];
  /** Whether the groups above have loaded, so that these may be requested. */
  readonly enabled: boolean;
}

/** The first of some groups of figures, followed by the others. */
function Groups({ studyKey, filter, groups, enabled }: GroupsProps): JSX.Element {
  const { t } = useTexts();
  const [group = FIRST, ...others] = groups;
  const query = useQuery({ ...dashboardQuery(studyKey, filter, group), enabled });
  const hasLoaded = enabled && !query.isPending && !query.isPlaceholderData;
  return (
    <>
      <section className={classes.group}>
        <Title order={2} className={classes.groupTitle ?? ""}>
          {t(`figures.group.${group}`)}
        </Title>
        <Loaded query={query}>
          {(dashboard) => <Figures studyKey={studyKey} dashboard={dashboard} />}
        </Loaded>
      </section>
      {others.length > 0 && (
        <Groups studyKey={studyKey} filter={filter} groups={others} enabled={hasLoaded} />
      )}
    </>
  );
}

interface FiguresProps {
  readonly studyKey: string;
  readonly dashboard: Dashboard;
}

function Figures({ studyKey, dashboard }: FiguresProps): JSX.Element {
  const { t } = useTexts();
  // What is shown, which right after a choice is not yet what is requested.
  const { kind, filter, figures } = dashboard;
  const drawn: Filter = {
    ...filterFrom(new URLSearchParams({ kind })),
    ...filter,
    participant: filter.participant ?? [],
  } as Filter;
  if (figures.length === 0) {
    return (
      <EmptyState icon="chart" title={t("dashboard.empty.title")}>
        {t("dashboard.empty.body")}
      </EmptyState>
    );
  }
  return (
    <div className={classes.figures}>
      {figures.map((entry) => (
        <FigureCard key={entry.key} studyKey={studyKey} entry={entry} filter={drawn} />
      ))}
    </div>
  );
}

/** The filter, kept in the page's address, so that a shared link shows the same figures. */
function useFilter(studyKey: string): readonly [Filter, (next: Filter) => void] {
  const [place, navigate] = useLocation();
  const search = useSearch();
  const filter = { ...filterFrom(new URLSearchParams(search)), kind: kindOf(studyKey, search) };
  useOwnSearch();
  useRememberedKind(studyKey, filter.kind);
  // Replace the address: going back leaves the page instead of undoing a filter.
  const setFilter = (next: Filter): void => {
    const chosen = searchOf(next);
    // Also the usual kind: what was last shown would otherwise take its place.
    chosen.set("kind", next.kind);
    navigate(`${place}?${chosen}`, { replace: true });
  };
  return [filter, setFilter];
}
