/**
 * Erase a participant: what is deleted, what stays, which copies are left, and the code typed as
 * confirmation.
 */
import { Button, Group, Modal, Select, Stack, TextInput } from "@mantine/core";
import { type ErasureReason, type Participant, rights } from "@shared/api/rights";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useShown } from "../ui/page";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { CopyList } from "./CopyList";
import classes from "./Rights.module.css";
import { Tombstone } from "./Tombstone";

interface EraseDialogProps {
  readonly studyKey: string;
  /** The participant to erase; null while the dialog is closed. */
  readonly participant: Participant | null;
  readonly onClose: () => void;
}

export function EraseDialog({ studyKey, participant, onClose }: EraseDialogProps): JSX.Element {
  const { t } = useTexts();
  const named = useShown(participant);
  return (
    <Modal
      opened={participant !== null}
      onClose={onClose}
      size="lg"
      title={named && t("erase.title", { code: named.code })}
      closeOnClickOutside={false}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {participant !== null && (
        <Erase studyKey={studyKey} participant={participant} onClose={onClose} />
      )}
    </Modal>
  );
}

const REASONS: readonly ErasureReason[] = ["withdrawn", "requested", "retention", "mistake"];
const ERASED = ["movement", "answers", "words", "devices", "code"] as const;
const STAYS = ["session", "log", "tombstone"] as const;

interface EraseProps extends EraseDialogProps {
  readonly participant: Participant;
}

function Erase({ studyKey, participant, onClose }: EraseProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const withdrew = participant.sessions.some(({ status }) => status === "withdrawn");
  const [reason, setReason] = useState<ErasureReason>(withdrew ? "withdrawn" : "requested");
  const [typed, setTyped] = useState("");
  // The result names the participant, whose name is then gone: it is kept while this is open.
  const [code] = useState(participant.code);
  const erase = useMutation({
    mutationFn: () => rights.erase(studyKey, participant.id, typed, reason),
    onSuccess: () => {
      void queries.invalidateQueries({ queryKey: ["studies", studyKey] });
      void queries.invalidateQueries({ queryKey: ["sessions"] });
    },
  });
  const submit = useSingleSubmit(erase);
  if (erase.data !== undefined) return <Tombstone erasure={erase.data} onClose={onClose} />;
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (typed === code) submit();
      }}
    >
      <Stack>
        <div className={classes.both}>
          <Facts title={t("erase.goes")} icon="close">
            {ERASED.map((what) => t(`erase.goes.${what}`, { code }))}
          </Facts>
          <Facts title={t("erase.stays")} icon="check">
            {STAYS.map((what) => t(`erase.stays.${what}`))}
          </Facts>
        </div>
        <div>
          <h3 className={classes.small}>{t("erase.copies")}</h3>
          {participant.copies.length === 0 ? (
            <p className={classes.soft}>{t("erase.copies.none")}</p>
          ) : (
            <>
              <CopyList copies={participant.copies} />
              <p className={classes.soft}>{t("erase.copies.later")}</p>
            </>
          )}
        </div>
        <Select
          label={t("erase.why")}
          allowDeselect={false}
          data={REASONS.map((value) => ({ value, label: t(`rights.reason.${value}`) }))}
          value={reason}
          onChange={(value) => setReason((value as ErasureReason | null) ?? reason)}
        />
        <TextInput
          label={t("erase.confirm", { code })}
          data-autofocus
          autoComplete="off"
          spellCheck={false}
          value={typed}
          onChange={(event) => setTyped(event.currentTarget.value.trim())}
        />
        {erase.isError && <Failure error={erase.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" color="red" disabled={typed !== code} loading={erase.isPending}>
            {t("erase.do")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}

interface FactsProps {
  readonly title: string;
  readonly icon: IconName;
  readonly children: readonly string[];
}

function Facts({ title, icon, children }: FactsProps): JSX.Element {
  return (
    <div>
      <h3 className={classes.small}>{title}</h3>
      <ul className={classes.facts}>
        {children.map((fact) => (
          <li key={fact}>
            <Icon name={icon} size={16} />
            {fact}
          </li>
        ))}
      </ul>
    </div>
  );
}
