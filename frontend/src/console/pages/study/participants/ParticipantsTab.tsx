/** The study's participants, and their rights: a copy, a correction, and erasure. */
import { Modal, TextInput } from "@mantine/core";
import { useSessionStorage } from "@mantine/hooks";
import type { Participant } from "@shared/api/rights";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../../../i18n";
import { participantsQuery } from "../../../queries";
import { AnswersDrawer } from "../../../rights/AnswersDrawer";
import { EraseDialog } from "../../../rights/EraseDialog";
import { Tombstone } from "../../../rights/Tombstone";
import { EmptyState } from "../../../ui/EmptyState";
import { Loaded } from "../../../ui/Loaded";
import page from "../StudyPage.module.css";
import { ParticipantTable } from "./ParticipantTable";

interface Answering {
  readonly sessionId: string;
  readonly code: string;
}

export function ParticipantsTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [search, setSearch] = useSessionStorage({
    key: `reembody.participants.${study.key}`,
    defaultValue: "",
    getInitialValueInEffect: false,
  });
  const [erasing, setErasing] = useState<Participant | null>(null);
  const [erased, setErased] = useState<Participant | null>(null);
  const [answering, setAnswering] = useState<Answering | null>(null);
  const query = useQuery({ ...participantsQuery(study.key), refetchInterval: 30_000 });
  return (
    <>
      <div className={page.toolbar}>
        <TextInput
          type="search"
          aria-label={t("rights.search")}
          placeholder={t("rights.search")}
          w={280}
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
        />
      </div>
      <Loaded query={query}>
        {(everybody) => {
          const searched = search.trim().toLowerCase();
          const shown = everybody.filter(({ code }) => code.toLowerCase().includes(searched));
          if (shown.length === 0) return <NoParticipants searching={everybody.length > 0} />;
          return (
            <ParticipantTable
              studyKey={study.key}
              participants={shown}
              onCorrect={(sessionId, code) => setAnswering({ sessionId, code })}
              onErase={setErasing}
              onDetails={setErased}
            />
          );
        }}
      </Loaded>
      <EraseDialog studyKey={study.key} participant={erasing} onClose={() => setErasing(null)} />
      <TombstoneDialog
        participant={query.data?.find(({ id }) => id === erased?.id) ?? null}
        onClose={() => setErased(null)}
      />
      <AnswersDrawer
        sessionId={answering?.sessionId ?? ""}
        code={answering?.code ?? ""}
        opened={answering !== null}
        onClose={() => setAnswering(null)}
      />
    </>
  );
}

function NoParticipants({ searching }: { readonly searching: boolean }): JSX.Element {
  const { t } = useTexts();
  return searching ? (
    <EmptyState icon="people" title={t("rights.none")}>
      {t("rights.none.body")}
    </EmptyState>
  ) : (
    <EmptyState icon="people" title={t("rights.empty")}>
      <Icon name="info" size={16} /> {t("rights.empty.body")}
    </EmptyState>
  );
}

interface TombstoneDialogProps {
  readonly participant: Participant | null;
  readonly onClose: () => void;
}

/** What was erased of a participant. */
function TombstoneDialog({ participant, onClose }: TombstoneDialogProps): JSX.Element {
  const { t } = useTexts();
  const erasure = participant?.erasure ?? null;
  return (
    <Modal
      opened={erasure !== null}
      onClose={onClose}
      size="lg"
      title={t("tombstone.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {erasure !== null && <Tombstone erasure={erasure} onClose={onClose} />}
    </Modal>
  );
}
