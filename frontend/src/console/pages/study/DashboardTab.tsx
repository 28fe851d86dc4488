/**
 * The study's figures, drawn by the server from the selected sessions of one kind.
 *
 * The groups are requested one after the other, from the top, so the first is shown early.
 */
import { Button, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import {
  type Dashboard,
  type FigureGroup,
  type Filter,
  filterFrom,
  searchOf,
} from "@shared/api/analysis";
import { DEMO_KEY } from "@shared/api/housekeeping";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useLocation, useSearch } from "wouter";
import { Failure } from "../../errors";
import { SECTIONS } from "../../frame/places";
import { useTexts } from "../../i18n";
import { dashboardQuery } from "../../queries";
import { Counted } from "../../ui/Counted";
import { kindOf, useOwnSearch, useRememberedKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { BeingDrawn } from "./BeingDrawn";
import classes from "./DashboardTab.module.css";
import { FigureCard } from "./FigureCard";
import { FilterBar } from "./FilterBar";
import { chosenFields, unfiltered } from "./filters";
import { StudyHead, type StudySection } from "./StudyHead";
import { SummaryRow } from "./SummaryRow";

/** What the study is about comes first; the summary row above says how far it is. */
const FIRST = "embodiment";
const AFTERWARDS = ["tasks", "movement", "answers", "demographics", "progress", "quality"] as const;
const SECTION = SECTIONS.find(({ section }) => section === "dashboard") as StudySection;

export function DashboardTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [filter, setFilter] = useFilter(study.key);
  const found = useQuery(dashboardQuery(study.key, filter, FIRST)).data;
  const chosen = chosenFields(filter);
  // The study's state does not depend on what somebody looks at.
  const all = useQuery(dashboardQuery(study.key, unfiltered(filter.kind), FIRST)).data;
  const [choosing, choice] = useDisclosure(chosen > 0);
  return (
    <>
      <StudyHead study={study} section={SECTION}>
        <KindFilter kind={filter.kind} onChange={(kind) => setFilter(unfiltered(kind))} />
        <Button
          size="xs"
          variant={chosen > 0 ? "light" : "default"}
          leftSection={<Icon name="down" size={15} />}
          aria-expanded={choosing}
          onClick={choice.toggle}
        >
          {chosen > 0 ? t("figures.chosen", { count: chosen }) : t("figures.choose")}
        </Button>
        <Counted
          found={found}
          running={found?.n_running ?? 0}
          doing={found?.current === false ? t("dashboard.drawing") : null}
        />
      </StudyHead>
      {/* On the demo lab's pages the strip above says it. */}
      {filter.kind === "simulated" && study.key !== DEMO_KEY && (
        <div className={classes.simulated}>
          <Notice tone="sim" title={t("simulated.title")} compact>
            {t("simulated.body")}
          </Notice>
        </div>
      )}
      {choosing && found !== undefined && (
        <FilterBar filter={filter} choices={found.choices} onChange={setFilter} />
      )}
      <SummaryRow
        study={study}
        kind={filter.kind}
        found={all}
        isBehind={all?.current === false}
        note={chosen > 0 ? t("summary.unfiltered") : undefined}
      />
      {found?.filter.rows === "all" && (
        <div className={classes.banner}>
          <Notice tone="warn" title={t("figures.all")}>
            {t("figures.all.body")}
          </Notice>
        </div>
      )}
      <Groups studyKey={study.key} filter={filter} groups={[FIRST, ...AFTERWARDS]} />
    </>
  );
}

interface GroupsProps {
  readonly studyKey: string;
  readonly filter: Filter;
  readonly groups: readonly FigureGroup[];
}

/** The first of some groups of figures; the others are requested once it is there. */
function Groups({ studyKey, filter, groups }: GroupsProps): JSX.Element {
  const { t } = useTexts();
  const [group = FIRST, ...others] = groups;
  const query = useQuery(dashboardQuery(studyKey, filter, group));
  const isMain = group === FIRST;
  return (
    <>
      <section className={classes.group}>
        <Title order={2} className={isMain ? "visually-hidden" : (classes.groupTitle ?? "")}>
          {t(`figures.group.${group}`)}
        </Title>
        {query.data !== undefined ? (
          <Figures studyKey={studyKey} dashboard={query.data} isMain={isMain} />
        ) : query.isError ? (
          <Failure error={query.error} onRetry={() => void query.refetch()} />
        ) : (
          <BeingDrawn studyKey={studyKey} kind={filter.kind} group={group} isMain={isMain} />
        )}
      </section>
      {others.length > 0 && query.data !== undefined && (
        <Groups studyKey={studyKey} filter={filter} groups={others} />
      )}
    </>
  );
}

interface FiguresProps {
  readonly studyKey: string;
  readonly dashboard: Dashboard;
  readonly isMain: boolean;
}

function Figures({ studyKey, dashboard, isMain }: FiguresProps): JSX.Element {
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
    <div className={isMain ? `${classes.figures} ${classes.main}` : classes.figures}>
      {figures.map((entry) => (
        <FigureCard
          key={entry.key}
          studyKey={studyKey}
          entry={entry}
          filter={drawn}
          isCompact={isMain}
        />
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
