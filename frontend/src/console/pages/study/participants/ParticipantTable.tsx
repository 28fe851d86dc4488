/** One row for each participant; what was erased stays as a tombstone. */
import { Button, Group, Menu, Table } from "@mantine/core";
import { type Participant, rights, type Visit } from "@shared/api/rights";
import { dateTime, day } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { Failure } from "../../../errors";
import { useTexts } from "../../../i18n";
import { KindBadge, StatusBadge } from "../../../ui/badges";
import frame from "../SessionsTab.module.css";
import { useDownload } from "../useDownload";
import classes from "./Participants.module.css";

interface ParticipantTableProps {
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
        <strong className={classes.code} title={participant.code}>
          {participant.code}
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

interface ActionsProps extends Omit<ParticipantTableProps, "participants"> {
  readonly participant: Participant;
}

/** What can be done for a participant; of one who was erased, what is left. */
function Actions({ participant, studyKey, ...props }: ActionsProps): JSX.Element {
  const { t } = useTexts();
  const { state, start } = useDownload();
  const left = participant.erasure?.remaining.filter((one) => one.destroyed_at === null) ?? [];
  if (participant.erasure !== null) {
    return (
      <Button
        size="xs"
        variant="default"
        leftSection={left.length > 0 && <Icon name="alert" size={16} />}
        onClick={() => props.onDetails(participant)}
      >
        {left.length === 0 ? t("rights.details") : t("rights.left", { count: left.length })}
      </Button>
    );
  }
  const running = participant.sessions.find(({ status }) => status === "active");
  return (
    <>
      <Group gap="xs">
        <Button
          size="xs"
          variant="default"
          leftSection={<Icon name="download" size={16} />}
          loading={state.phase === "running"}
          onClick={() =>
            void start(
              rights.accessUrl(studyKey, participant.id),
              `reembody_access_${participant.code}.zip`,
            )
          }
        >
          {t("rights.access")}
        </Button>
        <Correct participant={participant} onCorrect={props.onCorrect} />
        <EndIt running={running} participant={participant} onErase={props.onErase} />
      </Group>
      {state.phase === "failed" && <Failure error={state.error} />}
    </>
  );
}

interface CorrectProps {
  readonly participant: Participant;
  readonly onCorrect: (sessionId: string, code: string) => void;
}

function Correct({ participant, onCorrect }: CorrectProps): JSX.Element {
  const { t, language } = useTexts();
  const [only, ...more] = participant.sessions;
  const button = (onClick?: () => void) => (
    <Button
      size="xs"
      variant="default"
      leftSection={<Icon name="form" size={16} />}
      disabled={only === undefined}
      {...(onClick === undefined ? {} : { onClick })}
    >
      {t("rights.correct")}
    </Button>
  );
  if (only === undefined || more.length === 0) {
    return button(() => only !== undefined && onCorrect(only.id, participant.code));
  }
  return (
    <Menu>
      <Menu.Target>{button()}</Menu.Target>
      <Menu.Dropdown>
        <Menu.Label>{t("answers.which")}</Menu.Label>
        {participant.sessions.map((visit) => (
          <Menu.Item key={visit.id} onClick={() => onCorrect(visit.id, participant.code)}>
            {dateTime(visit.started_at ?? visit.created_at, language)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

interface EndItProps {
  readonly running: Visit | undefined;
  readonly participant: Participant;
  readonly onErase: (participant: Participant) => void;
}

/** Erasing waits for the end of a running session, so that one is offered in its place. */
function EndIt({ running, participant, onErase }: EndItProps): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  if (running !== undefined) {
    return (
      <Button
        size="xs"
        variant="default"
        title={t("rights.withdraw.hint")}
        leftSection={<Icon name="stop" size={16} />}
        onClick={() => navigate(`/sessions/${running.id}`)}
      >
        {t("rights.withdraw")}
      </Button>
    );
  }
  return (
    <Button
      size="xs"
      variant="outline"
      color="red"
      leftSection={<Icon name="close" size={16} />}
      onClick={() => onErase(participant)}
    >
      {t("rights.erase")}
    </Button>
  );
}
