/** Every session of the study, newest first; one click opens it. */
import { Button, SegmentedControl, Select, Table, TextInput } from "@mantine/core";
import type { Kind, SessionStatus, SessionSummary, StudyDetail } from "@shared/api/types";
import { dateTime, duration } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link, useLocation, useSearch } from "wouter";
import { useKeptSearch } from "../../frame/ownSearch";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { sessionsQuery } from "../../queries";
import { stepName } from "../../steps";
import { ActOnScreen } from "../../tour/ActOnScreen";
import { TryIt } from "../../tour/TryIt";
import { KindBadge, STATUSES, StatusBadge } from "../../ui/badges";
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
  const { chosen, choose } = useChoice();
  const [joining, setJoining] = useState(false);
  return (
    <>
      <div className={page.toolbar}>
        <SegmentedControl
          aria-label={t("kind.label")}
          value={chosen.kind}
          onChange={(value) => choose({ kind: value as Kind | "all" })}
          data={(["all", ...KINDS] as const).map((value) => ({ value, label: t(`kind.${value}`) }))}
        />
        <TextInput
          type="search"
          aria-label={t("rights.search")}
          placeholder={t("rights.search")}
          w={220}
          value={chosen.code}
          onChange={(event) => choose({ code: event.currentTarget.value })}
        />
        <Select
          aria-label={t("sessions.status")}
          placeholder={t("sessions.anyStatus")}
          w={170}
          value={chosen.status}
          onChange={(value) => choose({ status: value as SessionStatus | null })}
          data={STATUSES.map((value) => ({ value, label: t(`status.${value}`) }))}
          clearable
        />
      </div>
      <Loaded query={useQuery({ ...sessionsQuery(study.key), refetchInterval: 15_000 })}>
        {(sessions) => {
          const shown = sessions.filter(isChosen(chosen));
          if (shown.length > 0) return <SessionTable sessions={shown} />;
          if (sessions.length > 0) {
            return (
              <EmptyState
                icon="search"
                title={t("sessions.noMatch")}
                action={
                  <Button variant="default" onClick={() => choose(EVERYTHING)}>
                    {t("sessions.showAll")}
                  </Button>
                }
              >
                {t("sessions.noMatch.body", { count: sessions.length })}
              </EmptyState>
            );
          }
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

interface Choice {
  readonly kind: Kind | "all";
  readonly status: SessionStatus | null;
  /** A part of the participant's code. */
  readonly code: string;
}

const EVERYTHING: Choice = { kind: "all", status: null, code: "" };

const isChosen =
  ({ kind, status, code }: Choice) =>
  (session: SessionSummary): boolean =>
    (kind === "all" || session.kind === kind) &&
    (status === null || session.status === status) &&
    session.participant_code.toLowerCase().includes(code.trim().toLowerCase());

/** What is listed, kept in the page's address, so that a link and a reload show the same rows. */
function useChoice(): { readonly chosen: Choice; choose: (part: Partial<Choice>) => void } {
  const [place, navigate] = useLocation();
  const search = new URLSearchParams(useSearch());
  // All of it, as this list has kinds that the other pages of a study do not have.
  useKeptSearch([]);
  const chosen: Choice = {
    kind: KINDS.find((kind) => kind === search.get("kind")) ?? "all",
    status: STATUSES.find((status) => status === search.get("status")) ?? null,
    code: search.get("code") ?? "",
  };
  const choose = (part: Partial<Choice>) => {
    const { kind, status, code } = { ...chosen, ...part };
    const next = new URLSearchParams({
      // Also the usual kind: without any search, the router would keep the one before.
      kind,
      ...(status === null ? {} : { status }),
      ...(code === "" ? {} : { code }),
    });
    // Replace the address: going back leaves the page instead of undoing a choice.
    navigate(`${place}?${next}`, { replace: true });
  };
  return { chosen, choose };
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
        {session.step != null && (
          <span className={classes.sub}>
            {t("sessions.step", { number: session.step.index + 1, total: session.step.steps })}{" "}
            {t(stepName(session.step))}
            {session.step.paused && ` · ${t("device.says.paused")}`}
          </span>
        )}
        {session.end_reason != null && (
          <span className={classes.sub} title={session.end_reason}>
            {session.end_reason}
          </span>
        )}
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
      <Table.Td className={classes.when ?? ""}>
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
