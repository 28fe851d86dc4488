/**
 * The study's figures, drawn by the server from the selected sessions of one kind.
 *
 * The groups are requested one after the other, from the top, so the first is shown early.
 */
import { Title } from "@mantine/core";
import {
  type Asked,
  askedOf,
  type Dashboard,
  type FigureGroup,
  searchOf,
} from "@shared/api/analysis";
import type { StudyDetail } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useIsFetching, useQuery } from "@tanstack/react-query";
import { type JSX, useEffect } from "react";
import { useLocation, useSearch } from "wouter";
import { useTexts } from "../../i18n";
import { dashboardQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import classes from "./DashboardTab.module.css";
import { FigureCard } from "./FigureCard";
import { FilterBar } from "./FilterBar";
import page from "./StudyPage.module.css";

const FIRST = "progress";
const AFTERWARDS = ["embodiment", "answers", "tasks", "movement", "quality"] as const;

export function DashboardTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [asked, ask] = useAsked();
  const query = useQuery(dashboardQuery(study.key, asked, FIRST));
  const waiting = useIsFetching({ queryKey: ["studies", study.key, "dashboard"] }) > 0;
  return (
    <>
      <div className={page.toolbar}>
        <KindFilter
          kind={asked.kind}
          onChange={(kind) => ask({ ...askedOf(new URLSearchParams()), kind })}
        />
        {query.data !== undefined && (
          <span className={page.push}>
            {t("dashboard.sessions", {
              count: query.data.n_completed - query.data.n_not_valid,
            })}
            {query.data.n_not_valid > 0 &&
              ` · ${t("validity.excluded", { count: query.data.n_not_valid })}`}
            {(!query.data.current || waiting) && ` · ${t("dashboard.drawing")}`}
          </span>
        )}
      </div>
      <Loaded query={query}>
        {(dashboard) => (
          <>
            <FilterBar asked={asked} choices={dashboard.choices} onChange={ask} />
            <Banners dashboard={dashboard} />
            <Groups studyKey={study.key} asked={asked} groups={[FIRST, ...AFTERWARDS]} turn />
          </>
        )}
      </Loaded>
    </>
  );
}

function Banners({ dashboard }: { readonly dashboard: Dashboard }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      {dashboard.simulated && (
        <div className={classes.banner}>
          <Notice tone="sim" title={t("simulated.title")}>
            {t("simulated.body")}
          </Notice>
        </div>
      )}
      {dashboard.filter.rows === "all" && (
        <div className={classes.banner}>
          <Notice tone="warn" title={t("figures.all")}>
            {t("figures.all.body")}
          </Notice>
        </div>
      )}
    </>
  );
}

interface GroupsProps {
  readonly studyKey: string;
  readonly asked: Asked;
  readonly groups: readonly FigureGroup[];
  /** Whether the groups above have loaded, so that these may be requested. */
  readonly turn: boolean;
}

/** The first of some groups of figures, followed by the others. */
function Groups({ studyKey, asked, groups, turn }: GroupsProps): JSX.Element {
  const { t } = useTexts();
  const [group = FIRST, ...others] = groups;
  const query = useQuery({ ...dashboardQuery(studyKey, asked, group), enabled: turn });
  const there = turn && !query.isPending && !query.isPlaceholderData;
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
        <Groups studyKey={studyKey} asked={asked} groups={others} turn={there} />
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
  const drawn: Asked = {
    ...askedOf(new URLSearchParams({ kind })),
    ...filter,
    participant: filter.participant ?? [],
  } as Asked;
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
        <FigureCard key={entry.key} studyKey={studyKey} entry={entry} asked={drawn} />
      ))}
    </div>
  );
}

/**
 * The filter, kept in the page's address, so that a shared link shows the same figures.
 *
 * It is stored before the `#` of the page's route, and removed when the page is left.
 */
function useAsked(): readonly [Asked, (next: Asked) => void] {
  const [place, navigate] = useLocation();
  const search = useSearch();
  useEffect(() => {
    const own = window.location.hash;
    return () => {
      const { hash, pathname, search: left } = window.location;
      if (hash !== own && left !== "") history.replaceState(null, "", pathname + hash);
    };
  }, []);
  // Replace the address: going back leaves the page instead of undoing a filter.
  const ask = (next: Asked): void => navigate(`${place}?${searchOf(next)}`, { replace: true });
  return [askedOf(new URLSearchParams(search)), ask];
}
