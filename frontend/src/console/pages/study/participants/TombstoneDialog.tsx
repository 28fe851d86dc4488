/** What was erased of somebody. */
import { Modal } from "@mantine/core";
import type { Participant } from "@shared/api/rights";
import type { JSX } from "react";
import { useTexts } from "../../../i18n";
import { Tombstone } from "../../../rights/Tombstone";

interface TombstoneDialogProps {
  readonly participant: Participant | null;
  readonly onClose: () => void;
}

export function TombstoneDialog({ participant, onClose }: TombstoneDialogProps): JSX.Element {
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
