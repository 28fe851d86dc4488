/** Show a blinded session's condition before its end, for a reason that is recorded. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { blinding } from "@shared/api/people";
import type { SessionView } from "@shared/api/types";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { sessionQuery } from "../queries";
import { ReasonField } from "../ui/ReasonField";

const REASONS: readonly Key[] = [
  "blind.reason.adverse",
  "blind.reason.safety",
  "blind.reason.fault",
];

/** Renders nothing if no condition is hidden, or if it stays hidden for good. */
export function RevealCondition({
  session,
}: {
  readonly session: SessionView;
}): JSX.Element | null {
  const { t } = useTexts();
  const can = usePermissions();
  const [opened, { open, close }] = useDisclosure();
  if (!session.blinded || !can("reveal")) return null;
  return (
    <>
      <Button size="compact-xs" variant="default" onClick={open}>
        {t("blind.show")}
      </Button>
      <Modal
        opened={opened}
        onClose={close}
        title={t("blind.ask.title", { code: session.participant_code })}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <RevealForm session={session} onClose={close} />
      </Modal>
    </>
  );
}

interface RevealFormProps {
  readonly session: SessionView;
  readonly onClose: () => void;
}

function RevealForm({ session, onClose }: RevealFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [reason, setReason] = useState("");
  const reveal = useMutation({
    mutationFn: () => blinding.reveal(session.id, reason.trim()),
    onSuccess: (view) => {
      queries.setQueryData(sessionQuery(session.id).queryKey, view);
      onClose();
    },
  });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim() !== "") reveal.mutate();
      }}
    >
      <Stack>
        <Text c="dimmed">{t("blind.ask.body")}</Text>
        <ReasonField usual={REASONS} value={reason} onChange={setReason} />
        {reveal.isError && <Failure error={reveal.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={reason.trim() === ""} loading={reveal.isPending}>
            {t("blind.show")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
