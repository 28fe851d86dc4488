/** Every exception asks why, because the record keeps the reason; common reasons are one key away. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { ReasonField } from "../../ui/ReasonField";
import { useShown } from "../../ui/useShown";
import { COMMON_REASONS, type Reasoned } from "../session/reasons";
import { redoTarget } from "../session/redo";
import type { useSession } from "../session/useSession";
import { RedoChoice } from "./RedoChoice";

interface ReasonDialogProps {
  readonly type: Reasoned | null;
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
  readonly onClose: () => void;
}

export function ReasonDialog({ type, session, live, onClose }: ReasonDialogProps): JSX.Element {
  const { t } = useTexts();
  const named = useShown(type);
  return (
    <Modal
      opened={type !== null}
      onClose={onClose}
      title={named && t(`ask.${named}`)}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {type !== null && <ReasonForm type={type} session={session} live={live} onClose={onClose} />}
    </Modal>
  );
}

interface ReasonFormProps extends ReasonDialogProps {
  readonly type: Reasoned;
}

function ReasonForm({ type, session, live, onClose }: ReasonFormProps): JSX.Element {
  const { t } = useTexts();
  const [reason, setReason] = useState("");
  const [step, setStep] = useState(() => redoTarget(session));
  const grave = type === "abort" || type === "withdraw";
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim() === "") return;
        const which = type === "redo" ? { step_index: step } : {};
        live.send({ type, reason: reason.trim(), ...which }, onClose);
      }}
    >
      <Stack>
        <Text c="dimmed">{t(`ask.${type}.body`)}</Text>
        {type === "redo" && <RedoChoice session={session} step={step} onChange={setStep} />}
        <ReasonField usual={COMMON_REASONS[type]} value={reason} onChange={setReason} />
        {live.error !== null && <Failure error={live.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button
            type="submit"
            color={grave ? "red" : "petrol"}
            disabled={reason.trim() === ""}
            loading={live.sending}
          >
            {t(`do.${type}`)}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
