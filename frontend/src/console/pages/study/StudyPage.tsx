/** One study: its design, its ledger, its sessions, their results, and its files. */
import { Button, Title } from "@mantine/core";
import { versions } from "@shared/api/drafts";
import type { StudyDetail } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type ComponentType, type JSX, lazy, Suspense, useState } from "react";
import { Link } from "wouter";
import { useAccount } from "../../account";
import { Failure } from "../../errors";
import { isAllowed, SECTIONS, type SectionName } from "../../frame/places";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { studyQuery } from "../../queries";
import { Loaded, Waiting } from "../../ui/Loaded";
import { useTitle } from "../../ui/page";
import { NoPermission } from "../NoPermission";
import { LedgerTab } from "./LedgerTab";
import { NewSession } from "./NewSession";
import { Overview } from "./Overview";
import { SessionsTab } from "./SessionsTab";
import classes from "./StudyPage.module.css";

// Loaded when they are opened, as results are read by fewer people than run sessions.
const PreregistrationTab = lazy(async () => ({
  default: (await import("../../preregistration/PreregistrationTab")).PreregistrationTab,
}));
const DashboardTab = lazy(async () => ({
  default: (await import("./DashboardTab")).DashboardTab,
}));
const ExportTab = lazy(async () => ({
  default: (await import("./ExportTab")).ExportTab,
}));
const ProtocolTab = lazy(async () => ({
  default: (await import("./ProtocolTab")).ProtocolTab,
}));
const ParticipantsTab = lazy(async () => ({
  default: (await import("./participants/ParticipantsTab")).ParticipantsTab,
}));
const StatisticsTab = lazy(async () => ({
  default: (await import("./StatisticsTab")).StatisticsTab,
}));
const SuggestionsTab = lazy(async () => ({
  default: (await import("./SuggestionsTab")).SuggestionsTab,
}));
const SummaryTab = lazy(async () => ({
  default: (await import("./SummaryTab")).SummaryTab,
}));
const VersionsTab = lazy(async () => ({
  default: (await import("./VersionsTab")).VersionsTab,
}));

const CONTENT: Readonly<Record<SectionName, ComponentType<{ readonly study: StudyDetail }>>> = {
  overview: Overview,
  ledger: LedgerTab,
  sessions: SessionsTab,
  participants: ParticipantsTab,
  summary: SummaryTab,
  dashboard: DashboardTab,
  statistics: StatisticsTab,
  preregistration: PreregistrationTab,
  export: ExportTab,
  protocol: ProtocolTab,
  versions: VersionsTab,
  suggestions: SuggestionsTab,
};

type StudySection = (typeof SECTIONS)[number];
const OVERVIEW: StudySection = SECTIONS[0];

interface StudyPageProps {
  readonly studyKey: string;
  readonly tab: string | undefined;
}

export function StudyPage({ studyKey, tab }: StudyPageProps): JSX.Element {
  return (
    <Loaded query={useQuery(studyQuery(studyKey))}>
      {(study) => (
        <Study
          study={study}
          section={SECTIONS.find(({ section }) => section === tab) ?? OVERVIEW}
        />
      )}
    </Loaded>
  );
}

interface StudyProps {
  readonly study: StudyDetail;
  readonly section: StudySection;
}

function Study({ study, section }: StudyProps): JSX.Element {
  const role = useAccount().data?.role;
  const isTheirs = role !== undefined && isAllowed(section, role);
  const Content = isTheirs ? CONTENT[section.section] : NoPermission;
  return (
    <div data-page={section.section === "dashboard" ? "wide" : undefined}>
      <Head study={study} section={section} />
      {study.archived_at !== null && <Archived studyKey={study.key} />}
      <Suspense fallback={<Waiting />}>
        <Content study={study} />
      </Suspense>
    </div>
  );
}

/** The overview is titled with the study, every other page with its own name and the study above. */
function Head({ study, section }: StudyProps): JSX.Element {
  const { t, language } = useTexts();
  const [joining, setJoining] = useState(false);
  const can = usePermissions();
  const title = study.protocol === null ? study.title : inLanguage(study.protocol.title, language);
  const isOverview = section.section === "overview";
  useTitle(isOverview ? title : `${t(section.name)} · ${title}`);
  return (
    <div className={classes.head}>
      <div>
        {!isOverview && (
          <Link href={`/studies/${study.key}/overview`} className={classes.crumbs ?? ""}>
            {title}
          </Link>
        )}
        <Title order={1}>{isOverview ? title : t(section.name)}</Title>
        {isOverview && (
          <div className={classes.meta}>
            <span>{study.key}</span>
            <span>{t("study.version", { version: study.version })}</span>
            <span>
              <Icon name={study.frozen ? "lock" : "document"} size={15} />
              {t(study.frozen ? "study.frozenLong" : "study.openLong")}
            </span>
          </div>
        )}
      </div>
      {can("run") && section.group === "run" && (
        <Button
          leftSection={<Icon name="add" size={18} />}
          disabled={study.archived_at !== null}
          onClick={() => setJoining(true)}
        >
          {t("join.open")}
        </Button>
      )}
      <NewSession study={study} opened={joining} onClose={() => setJoining(false)} />
    </div>
  );
}

/** A notice that a study is archived, with a button that restores it. */
function Archived({ studyKey }: { readonly studyKey: string }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const queries = useQueryClient();
  const restore = useMutation({
    mutationFn: () => versions.restore(studyKey),
    onSuccess: () => queries.invalidateQueries({ queryKey: ["studies"] }),
  });
  return (
    <div style={{ marginBottom: 16 }}>
      {restore.isError && <Failure error={restore.error} />}
      <Notice
        tone="warn"
        icon="lock"
        title={t("versions.archived")}
        actions={
          can("design") && (
            <Button
              size="xs"
              variant="default"
              loading={restore.isPending}
              onClick={() => restore.mutate()}
            >
              {t("versions.restore")}
            </Button>
          )
        }
      >
        {t("versions.archived.body")}
      </Notice>
    </div>
  );
}
