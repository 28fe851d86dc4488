/** One study: its design, its ledger, its sessions, their results, and its files. */
import { Button } from "@mantine/core";
import { versions } from "@shared/api/drafts";
import type { StudyDetail } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type ComponentType, type JSX, lazy, Suspense } from "react";
import { useAccount } from "../../account";
import { Failure } from "../../errors";
import { isAllowed, SECTIONS, type SectionName } from "../../frame/places";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { studyQuery } from "../../queries";
import { Loaded, Waiting } from "../../ui/Loaded";
import { NoPermission } from "../NoPermission";
import { LedgerTab } from "./LedgerTab";
import { Overview } from "./Overview";
import { SessionsTab } from "./SessionsTab";
import { StudyHead, type StudySection } from "./StudyHead";

// Loaded when they are opened, as results are read by fewer people than run sessions.
const PreregistrationTab = lazy(async () => ({
  default: (await import("../../preregistration/PreregistrationTab")).PreregistrationTab,
}));
const PilotTab = lazy(async () => ({
  default: (await import("../../pilot/PilotTab")).PilotTab,
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
  pilot: PilotTab,
  versions: VersionsTab,
  suggestions: SuggestionsTab,
};

const OVERVIEW: StudySection = SECTIONS[0];
/** Its choices stand in the row of its title. */
const HEADS_ITSELF: SectionName = "dashboard";

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
      {!(isTheirs && section.section === HEADS_ITSELF) && (
        <StudyHead study={study} section={section} />
      )}
      {study.archived_at !== null && <Archived studyKey={study.key} />}
      <Suspense fallback={<Waiting />}>
        <Content study={study} />
      </Suspense>
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
