/** Every session of the study, newest first; one click opens it. */
import { Button, SegmentedControl, Table } from "@mantine/core";
import type { Kind, SessionSummary, StudyDetail } from "@shared/api/types";
import { dateTime, duration } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link, useLocation } from "wouter";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { sessionsQuery } from "../../queries";
import { ActOnScreen } from "../../tour/ActOnScreen";
import { TryIt } from "../../tour/TryIt";
import { KindBadge, StatusBadge } from "../../ui/badges";
import { EmptyState } from "../../ui/EmptyState";
import { KINDS } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { Order } from "../../ui/Order";
import { NewSession } from "./NewSession";
import classes from "./SessionsTab.module.css";
import page from "./StudyPage.module.css";

export function SessionsTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [kind, setKind] = useState<Kind | "all">("all");
  const [joining, setJoining] = useState(false);
  return (
    <>
      <div className={page.toolbar}>
        <SegmentedControl
          aria-label={t("kind.label")}
          value={kind}
          onChange={(value) => setKind(value as Kind | "all")}
          data={(["all", ...KINDS] as const).map((value) => ({ value, label: t(`kind.${value}`) }))}
        />
      </div>
      <Loaded query={useQuery({ ...sessionsQuery(study.key), refetchInterval: 15_000 })}>
        {(sessions) => {
          const shown = sessions.filter((session) => kind === "all" || session.kind === kind);
          if (shown.length > 0) return <SessionTable sessions={shown} />;
          return (
            <EmptyState
              icon="people"
              title={t("sessions.empty.title")}
              action={
                <>
                  {can("run") && (
                    <Button
                      leftSection={<Icon name="add" size={18} />}
                      onClick={() => setJoining(true)}
                    >
                      {t("join.open")}
                    </Button>
                  )}
                  {sessions.length === 0 && <TryIt study={study} />}
                  {sessions.length === 0 && <ActOnScreen study={study} />}
                </>
              }
            >
              {t("sessions.empty.body")}
            </EmptyState>
          );
        }}
      </Loaded>
      <NewSession study={study} opened={joining} onClose={() => setJoining(false)} />
    </>
  );
}

const COLUMNS = ["participant", "status", "kind", "order", "started", "duration"] as const;

function SessionTable({ sessions }: { readonly sessions: readonly SessionSummary[] }): JSX.Element {
  const { t } = useTexts();
  const newestFirst = [...sessions].sort((a, b) => b.created_at.localeCompare(a.created_at));
  return (
    <div className={classes.frame}>
      <Table highlightOnHover verticalSpacing="sm" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            {COLUMNS.map((column) => (
              <Table.Th key={column}>{t(`sessions.${column}`)}</Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {newestFirst.map((session) => (
            <Row key={session.id} session={session} />
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}

function Row({ session }: { readonly session: SessionSummary }): JSX.Element {
  const { t, language } = useTexts();
  const [, navigate] = useLocation();
  return (
    <Table.Tr className={classes.row ?? ""} onClick={() => navigate(`/sessions/${session.id}`)}>
      <Table.Td>
        <Link
          href={`/sessions/${session.id}`}
          className={classes.code ?? ""}
          title={session.participant_code}
        >
          {session.participant_code}
        </Link>
      </Table.Td>
      <Table.Td>
        <StatusBadge status={session.status} />
        {(session.shortfalls?.length ?? 0) > 0 && (
          <span className={classes.sub}>{t("validity.notValid")}</span>
        )}
      </Table.Td>
      <Table.Td>
        <KindBadge kind={session.kind} />
      </Table.Td>
      <Table.Td>
        {session.sequence === null ? (
          t("order.hidden")
        ) : (
          <Order sequence={session.sequence} bodies={session.bodies} />
        )}
      </Table.Td>
      <Table.Td>
        {session.started_at === null
          ? t("sessions.notStarted")
          : dateTime(session.started_at, language)}
      </Table.Td>
      <Table.Td className="numbers">{lengthOf(session) ?? "–"}</Table.Td>
    </Table.Tr>
  );
}

/** How long the session took; null until it has ended. */
function lengthOf({ started_at, ended_at }: SessionSummary): string | null {
  if (started_at === null || ended_at === null) return null;
  return duration(seconds((Date.parse(ended_at) - Date.parse(started_at)) / 1000));
}
