/** Every exception asks why, because the record keeps the reason; common reasons are one key away. */
import { Button, Chip, Group, Modal, Stack, Text, Textarea } from "@mantine/core";
import type { CommandType } from "@shared/api/types";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import type { useSession } from "./useSession";

export type Reasoned = Extract<CommandType, "pause" | "redo" | "skip" | "abort" | "withdraw">;

const COMMON: Readonly<Record<Reasoned, readonly Key[]>> = {
  pause: ["reason.break", "reason.tracking", "reason.question"],
  redo: ["reason.tracking", "reason.misunderstood", "reason.interrupted"],
  skip: ["reason.askedAloud", "reason.time", "reason.wish"],
  abort: ["reason.equipment", "reason.time", "reason.interrupted"],
  withdraw: ["reason.wish", "reason.sick", "reason.unwell"],
};

interface ReasonDialogProps {
  readonly type: Reasoned | null;
  readonly live: ReturnType<typeof useSession>;
  readonly onClose: () => void;
}

export function ReasonDialog({ type, live, onClose }: ReasonDialogProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={type !== null}
      onClose={onClose}
      title={type === null ? "" : t(`ask.${type}`)}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {type !== null && <ReasonForm type={type} live={live} onClose={onClose} />}
    </Modal>
  );
}

interface ReasonFormProps extends ReasonDialogProps {
  readonly type: Reasoned;
}

function ReasonForm({ type, live, onClose }: ReasonFormProps): JSX.Element {
  const { t } = useTexts();
  const [reason, setReason] = useState("");
  const grave = type === "abort" || type === "withdraw";
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim() !== "") live.send({ type, reason: reason.trim() }, onClose);
      }}
    >
      <Stack>
        <Text c="dimmed">{t(`ask.${type}.body`)}</Text>
        <Group gap="xs">
          {COMMON[type].map((key) => (
            <Chip key={key} checked={reason === t(key)} onChange={() => setReason(t(key))}>
              {t(key)}
            </Chip>
          ))}
        </Group>
        <Textarea
          label={t("ask.reason")}
          data-autofocus
          autosize
          minRows={2}
          maxLength={500}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
          onKeyDown={(event) => {
            if (event.key !== "Enter" || event.shiftKey) return;
            event.preventDefault();
            event.currentTarget.form?.requestSubmit();
          }}
        />
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
