/** Participants' rights: a copy of their data, a correction, and erasure. */
import { Button, Group, Menu } from "@mantine/core";
import { type Participant, rights, type Visit } from "@shared/api/rights";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useLocation } from "wouter";
import { Failure } from "../../../errors";
import { useTexts } from "../../../i18n";
import { useDownload } from "../useDownload";

export interface ActionsProps {
  readonly studyKey: string;
  readonly participant: Participant;
  readonly onCorrect: (sessionId: string, code: string) => void;
  readonly onErase: (participant: Participant) => void;
  readonly onDetails: (participant: Participant) => void;
}

/** The actions for a participant; for an erased one, what remains. */
export function Actions({ participant, studyKey, ...props }: ActionsProps): JSX.Element {
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
        <EndSession running={running} participant={participant} onErase={props.onErase} />
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

/** Erasing waits for the end of a running session, so ending it is offered instead. */
function EndSession({ running, participant, onErase }: EndItProps): JSX.Element {
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
