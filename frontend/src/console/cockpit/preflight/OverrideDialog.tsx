/** Override failed checks: the reason becomes part of the record. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import type { Check, SessionView } from "@shared/api/types";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { preflightQuery } from "../../queries";
import { useShown } from "../../ui/page";
import { ReasonField } from "../../ui/ReasonField";
import type { useSession } from "../session/useSession";
import { CheckList } from "./CheckList";
import { failing } from "./checkTexts";
import { type Flight, overrideAll } from "./usePreflight";

interface OverrideDialogProps {
  readonly session: SessionView;
  /** Null: the dialog is closed. Empty: all checks have passed since it was opened. */
  readonly checks: readonly Check[] | null;
  readonly onClose: () => void;
  /** Called once the reasons are recorded: it starts the session. */
  readonly then?: () => Promise<unknown>;
}

export function OverrideDialog({ checks, ...props }: OverrideDialogProps): JSX.Element {
  const { t } = useTexts();
  const shown = useShown(checks);
  const title = props.then === undefined ? "preflight.override.title" : "preflight.start.title";
  return (
    <Modal
      opened={checks !== null}
      onClose={props.onClose}
      size="lg"
      title={t(shown?.length === 0 ? "preflight.start.clear" : title)}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {shown !== null && <OverrideForm {...props} checks={shown} />}
    </Modal>
  );
}

const COMMON = [
  "preflight.reason.without",
  "preflight.reason.soon",
  "preflight.reason.known",
] as const;

interface OverrideFormProps extends OverrideDialogProps {
  readonly checks: readonly Check[];
}

/** The field stays even when no reason is needed any more: somebody may be typing in it. */
function OverrideForm({ session, checks, onClose, then }: OverrideFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [reason, setReason] = useState("");
  const clear = checks.length === 0;
  const doing = clear ? "do.start" : "preflight.start.do";
  const ready = clear || reason.trim() !== "";
  const save = useMutation({
    mutationFn: async () => {
      await overrideAll(session.id, checks, reason.trim());
      await then?.();
    },
    onSuccess: onClose,
    onSettled: () => queries.invalidateQueries(preflightQuery(session.id)),
  });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (ready && !save.isPending) save.mutate();
      }}
    >
      <Stack>
        {!clear && <CheckList checks={checks} />}
        <Text c="dimmed">{t(clear ? "preflight.start.clear.body" : "preflight.start.body")}</Text>
        {then !== undefined && !clear && session.kind === "people" && (
          <Text>{t("preflight.start.test")}</Text>
        )}
        <ReasonField usual={COMMON} value={reason} onChange={setReason} />
        {save.isError && <Failure error={save.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={!ready} loading={save.isPending}>
            {t(then === undefined ? "preflight.override" : doing)}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}

interface StartAnywayProps {
  readonly session: SessionView;
  readonly live: Pick<ReturnType<typeof useSession>, "sendAnew">;
  readonly flight: Flight;
}

/** The dialog for starting although a check has failed. */
export function StartAnyway({ session, live, flight }: StartAnywayProps): JSX.Element {
  const failed = failing(flight.query.data?.checks ?? []);
  const { asking, dismissReason } = flight;
  return (
    <OverrideDialog
      session={session}
      checks={asking ? failed : null}
      onClose={dismissReason}
      then={() => live.sendAnew(session, { type: "start" })}
    />
  );
}
