/**
 * One row for each participant; erased ones stay as tombstones. Each entry of `COLUMNS` is a column
 * with its title in both languages and its cell.
 */
import { Table } from "@mantine/core";
import type { Participant } from "@shared/api/rights";
import { dateTime, day } from "@shared/format";
import type { Language } from "@shared/i18n/i18n";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../../../i18n";
import { KindBadge, StatusBadge } from "../../../ui/badges";
import frame from "../SessionsTab.module.css";
import { Actions, type ActionsProps } from "./Actions";
import classes from "./Participants.module.css";

type CellProps = ActionsProps;

interface Column {
  readonly key: string;
  readonly title: Readonly<Record<Language, string>>;
  readonly Cell: (props: CellProps) => JSX.Element;
}

const COLUMNS: readonly Column[] = [
  { key: "code", title: { en: "Participant", de: "Person" }, Cell: Code },
  { key: "kind", title: { en: "Kind", de: "Art" }, Cell: Kind },
  { key: "sessions", title: { en: "Sessions", de: "Sitzungen" }, Cell: Sessions },
  {
    key: "actions",
    title: { en: "Participant’s rights", de: "Rechte der Person" },
    Cell: Actions,
  },
];

interface ParticipantTableProps extends Omit<CellProps, "participant"> {
  readonly participants: readonly Participant[];
}

export function ParticipantTable({ participants, ...props }: ParticipantTableProps): JSX.Element {
  const { language } = useTexts();
  return (
    <div className={frame.frame}>
      <Table verticalSpacing="sm" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            {COLUMNS.map(({ key, title }) => (
              <Table.Th key={key}>{title[language]}</Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {participants.map((one) => (
            <Table.Tr key={one.id} className={one.erasure === null ? "" : (classes.erased ?? "")}>
              {COLUMNS.map(({ key, Cell }) => (
                <Table.Td key={key}>
                  <Cell participant={one} {...props} />
                </Table.Td>
              ))}
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}

function Code({ participant: { code, erasure } }: CellProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <>
      <strong className={classes.code} title={code}>
        {code}
      </strong>
      {erasure !== null && (
        <div className={classes.soft}>
          <Icon name="lock" size={14} />
          {t("rights.erased.on", {
            date: day(erasure.at, language),
            by: erasure.by.replace("account:", ""),
          })}
        </div>
      )}
    </>
  );
}

function Kind({ participant }: CellProps): JSX.Element {
  return <KindBadge kind={participant.kind} />;
}

function Sessions({ participant }: CellProps): JSX.Element {
  const { language } = useTexts();
  return (
    <ul className={classes.visits}>
      {participant.sessions.map((visit) => (
        <li key={visit.id}>
          <StatusBadge status={visit.status} />
          <Link href={`/sessions/${visit.id}`} className={frame.code ?? ""}>
            {dateTime(visit.started_at ?? visit.created_at, language)}
          </Link>
        </li>
      ))}
    </ul>
  );
}
