/** One row for each participant; what was erased stays as a tombstone. */
import { Table } from "@mantine/core";
import type { Participant } from "@shared/api/rights";
import { dateTime, day } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../../../i18n";
import { KindBadge } from "../../../ui/KindBadge";
import { StatusBadge } from "../../../ui/StatusBadge";
import frame from "../SessionsTab.module.css";
import { Actions } from "./Actions";
import classes from "./Participants.module.css";

export interface ParticipantTableProps {
  readonly studyKey: string;
  readonly participants: readonly Participant[];
  readonly onCorrect: (sessionId: string, code: string) => void;
  readonly onErase: (participant: Participant) => void;
  readonly onDetails: (participant: Participant) => void;
}

export function ParticipantTable(props: ParticipantTableProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={frame.frame}>
      <Table verticalSpacing="sm" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{t("rights.participant")}</Table.Th>
            <Table.Th>{t("sessions.kind")}</Table.Th>
            <Table.Th>{t("rights.sessions")}</Table.Th>
            <Table.Th>{t("rights.actions")}</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {props.participants.map((one) => (
            <Row key={one.id} participant={one} {...props} />
          ))}
        </Table.Tbody>
      </Table>
    </div>
  );
}

interface RowProps extends ParticipantTableProps {
  readonly participant: Participant;
}

function Row({ participant, ...props }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const { erasure } = participant;
  return (
    <Table.Tr className={erasure === null ? "" : (classes.erased ?? "")}>
      <Table.Td>
        <strong className={classes.code}>{participant.code}</strong>
        {erasure !== null && (
          <div className={classes.soft}>
            <Icon name="lock" size={14} />
            {t("rights.erased.on", {
              date: day(erasure.at, language),
              by: erasure.by.replace("account:", ""),
            })}
          </div>
        )}
      </Table.Td>
      <Table.Td>
        <KindBadge kind={participant.kind} />
      </Table.Td>
      <Table.Td>
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
      </Table.Td>
      <Table.Td>
        <Actions participant={participant} {...props} />
      </Table.Td>
    </Table.Tr>
  );
}
