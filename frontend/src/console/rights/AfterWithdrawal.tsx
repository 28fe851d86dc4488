/**
 * After a withdrawal: keep the data collected so far, or erase them, or show that they were erased.
 */
import { Button, Group } from "@mantine/core";
import type { Participant } from "@shared/api/rights";
import type { Command, SessionView } from "@shared/api/types";
import { day } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { participantsQuery } from "../queries";
import { EraseDialog } from "./EraseDialog";
import { rightsDe, rightsEn } from "./texts";

/** The participant's decision is recorded as a note, in the language of the operator. */
const CONSENT_NOTES: readonly string[] = [rightsEn["withdrew.note"], rightsDe["withdrew.note"]];

interface AfterWithdrawalProps {
  readonly session: SessionView;
  readonly send: (command: Command) => void;
}

export function AfterWithdrawal({ session, send }: AfterWithdrawalProps): JSX.Element | null {
  const everybody = useQuery(participantsQuery(session.study_key)).data;
  const [erasing, setErasing] = useState<Participant | null>(null);
  const own = everybody?.find(({ sessions }) => sessions.some(({ id }) => id === session.id));
  if (own === undefined) return null;
  const isDecidedToKeep = session.notes.some(({ text }) => CONSENT_NOTES.includes(text));
  return (
    <>
      <Erased participant={own} />
      {session.status === "withdrawn" && own.erasure === null && !isDecidedToKeep && (
        <Question send={send} onErase={() => setErasing(own)} />
      )}
      <EraseDialog
        studyKey={session.study_key}
        participant={erasing}
        onClose={() => setErasing(null)}
      />
    </>
  );
}

interface QuestionProps {
  readonly send: (command: Command) => void;
  readonly onErase: () => void;
}

function Question({ send, onErase }: QuestionProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Notice
      tone="warn"
      icon="people"
      title={t("withdrew.title")}
      actions={
        <Group>
          <Button
            variant="default"
            onClick={() => send({ type: "note", text: t("withdrew.note") })}
          >
            {t("withdrew.keep")}
          </Button>
          <Button color="red" variant="outline" onClick={onErase}>
            {t("withdrew.erase")}
          </Button>
        </Group>
      }
    >
      {t("withdrew.body")}
    </Notice>
  );
}

function Erased({ participant }: { readonly participant: Participant }): JSX.Element | null {
  const { t, language } = useTexts();
  const { erasure } = participant;
  if (erasure === null) return null;
  return (
    <Notice tone="info" icon="lock" title={t("withdrew.erased")}>
      {t("withdrew.erased.body", {
        date: day(erasure.at, language),
        by: erasure.by.replace("account:", ""),
      })}
    </Notice>
  );
}
