/** One study: its design, its ledger, its sessions, their results, and its files. */
import { Button, Tabs, Title } from "@mantine/core";
import { versions } from "@shared/api/drafts";
import type { StudyDetail } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon, type IconName } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link, useLocation } from "wouter";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { type Permission, usePermissions } from "../../permissions";
import { PreregistrationTab } from "../../preregistration/PreregistrationTab";
import { studyQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { useTitle } from "../../ui/page";
import { NoPermission } from "../NoPermission";
import { DashboardTab } from "./DashboardTab";
import { ExportTab } from "./ExportTab";
import { LedgerTab } from "./LedgerTab";
import { NewSession } from "./NewSession";
import { Overview } from "./Overview";
import { ProtocolTab } from "./ProtocolTab";
import { ParticipantsTab } from "./participants/ParticipantsTab";
import { SessionsTab } from "./SessionsTab";
import { StatisticsTab } from "./StatisticsTab";
import classes from "./StudyPage.module.css";
import { SuggestionsTab } from "./SuggestionsTab";
import { VersionsTab } from "./VersionsTab";

const TABS = [
  "overview",
  "ledger",
  "sessions",
  "participants",
  "dashboard",
  "statistics",
  "preregistration",
  "export",
  "protocol",
  "versions",
  "suggestions",
] as const;
type Tab = (typeof TABS)[number];

const ICONS: Readonly<Record<Tab, IconName>> = {
  overview: "info",
  ledger: "list",
  sessions: "headset",
  participants: "people",
  dashboard: "chart",
  statistics: "form",
  preregistration: "lock",
  export: "download",
  protocol: "document",
  versions: "redo",
  suggestions: "talk",
};

const CONTENT: Readonly<Record<Tab, (props: { study: StudyDetail }) => JSX.Element>> = {
  overview: Overview,
  ledger: LedgerTab,
  sessions: SessionsTab,
  participants: ParticipantsTab,
  dashboard: DashboardTab,
  statistics: StatisticsTab,
  preregistration: PreregistrationTab,
  export: ExportTab,
  protocol: ProtocolTab,
  versions: VersionsTab,
  suggestions: SuggestionsTab,
};

/** The permission required for a tab; all others are for everybody. */
const NEEDS: Readonly<Partial<Record<Tab, Permission>>> = {
  participants: "rights",
  dashboard: "compare",
  statistics: "compare",
  preregistration: "compare",
  export: "compare",
  protocol: "compare",
  versions: "compare",
};

interface StudyPageProps {
  readonly studyKey: string;
  readonly tab: string | undefined;
}

export function StudyPage({ studyKey, tab }: StudyPageProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Link href="/" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("app.studies")}
      </Link>
      <Loaded query={useQuery(studyQuery(studyKey))}>
        {(study) => <Study study={study} tab={TABS.find((name) => name === tab) ?? "overview"} />}
      </Loaded>
    </>
  );
}

function Study({ study, tab }: { readonly study: StudyDetail; readonly tab: Tab }): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const can = usePermissions();
  const isTheirs = (name: Tab): boolean => {
    const act = NEEDS[name];
    return act === undefined || can(act);
  };
  const Content = isTheirs(tab) ? CONTENT[tab] : NoPermission;
  return (
    <>
      <Head study={study} />
      {study.archived_at !== null && <Archived studyKey={study.key} />}
      <Tabs
        value={tab}
        onChange={(value) => navigate(`/studies/${study.key}/${value ?? "overview"}`)}
        keepMounted={false}
        classNames={{ tab: classes.tab ?? "" }}
      >
        <Tabs.List>
          {TABS.filter(isTheirs).map((name) => (
            <Tabs.Tab key={name} value={name} leftSection={<Icon name={ICONS[name]} size={17} />}>
              {t(
                name === "versions" || name === "suggestions" ? `${name}.tab` : `study.tab.${name}`,
              )}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value={tab} className={classes.panel ?? ""}>
          <Content study={study} />
        </Tabs.Panel>
      </Tabs>
    </>
  );
}

function Head({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t, language } = useTexts();
  const [joining, setJoining] = useState(false);
  const can = usePermissions();
  const title = study.protocol === null ? study.title : inLanguage(study.protocol.title, language);
  useTitle(title);
  return (
    <div className={classes.head}>
      <div>
        <Title order={1}>{title}</Title>
        <div className={classes.meta}>
          <span>{study.key}</span>
          <span>{t("study.version", { version: study.version })}</span>
          <span>
            <Icon name={study.frozen ? "lock" : "document"} size={15} />
            {t(study.frozen ? "study.frozenLong" : "study.openLong")}
          </span>
        </div>
      </div>
      {can("run") && (
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
