/** Closing a door: at once, or after a question if sessions use what comes through it. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import { type Door, type SessionBehindDoor, trackers } from "@shared/api/trackers";
import { useMutation } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import classes from "./Trackers.module.css";

interface CloseDoorProps {
  readonly door: Door["door"];
  /** The door's name on the page. */
  readonly name: string;
  readonly isClosing: boolean;
  readonly onClose: () => void;
}

export function CloseDoor({ door, name, isClosing, onClose }: CloseDoorProps): JSX.Element {
  const { t } = useTexts();
  // Asked when it is needed: a session may have chosen a source a moment ago.
  const ask = useMutation({
    mutationFn: () => trackers.sessionsBehind(door),
    onSuccess: (sessions) => {
      if (sessions.length === 0) onClose();
    },
  });
  const users = ask.data ?? [];
  return (
    <>
      {ask.isError && <Failure error={ask.error} />}
      <Button
        variant="default"
        aria-label={t("trackers.closeDoor", { door: name })}
        loading={ask.isPending || isClosing}
        onClick={() => ask.mutate()}
      >
        {t("trackers.close")}
      </Button>
      <Modal
        opened={users.length > 0}
        onClose={ask.reset}
        title={t("trackers.closing.title", { door: name })}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <Stack>
          <Text>{t("trackers.closing.body")}</Text>
          <ul className={classes.users}>
            {users.map((one) => (
              <User key={one.session_id} session={one} />
            ))}
          </ul>
          <Group justify="flex-end">
            <Button variant="default" data-autofocus onClick={ask.reset}>
              {t("trackers.closing.keep")}
            </Button>
            <Button
              color="red"
              onClick={() => {
                ask.reset();
                onClose();
              }}
            >
              {t("trackers.closing.anyway")}
            </Button>
          </Group>
        </Stack>
      </Modal>
    </>
  );
}

function User({ session }: { readonly session: SessionBehindDoor }): JSX.Element {
  const { t } = useTexts();
  const uses = session.uses.map((use) => t(`trackers.closing.${use}`));
  return (
    <li>
      <Link href={`/sessions/${session.session_id}`} className={classes.link ?? ""}>
        {session.participant_code}
      </Link>
      : {uses.join(", ")}
    </li>
  );
}
