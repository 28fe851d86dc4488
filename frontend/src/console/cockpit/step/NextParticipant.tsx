/** After a session's end: the next one of the same study and kind, without a way through its pages. */
import { Button } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import type { SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { NewSession } from "../../pages/study/NewSession";
import { studyQuery } from "../../queries";
import classes from "./CurrentStep.module.css";

export function NextParticipant({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const [opened, { open, close }] = useDisclosure();
  const study = useQuery(studyQuery(session.study_key)).data;
  return (
    <>
      <Button
        size="lg"
        className={classes.primary ?? ""}
        leftSection={<Icon name="add" />}
        disabled={study === undefined || study.archived_at !== null}
        onClick={open}
      >
        {t("session.next")}
      </Button>
      {study !== undefined && (
        <NewSession study={study} firstKind={session.kind} opened={opened} onClose={close} />
      )}
    </>
  );
}
