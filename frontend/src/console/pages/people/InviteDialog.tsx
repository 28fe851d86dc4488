/** Invite somebody: choose role, studies and validity, then show the link, once. */
import {
  Button,
  CopyButton,
  Group,
  Input,
  Modal,
  SegmentedControl,
  Stack,
  TextInput,
} from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { type Invited, invitations, type Role, type StudyKeys } from "@shared/api/people";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { invitationsQuery } from "../../queries";
import { RoleBadge } from "../../ui/badges";
import { useFormSubmit } from "../../ui/useSingleSubmit";
import { lanCommand } from "../network/lanCommand";
import { RoleChoice, StudiesChoice } from "./RoleAndStudies";

export function InviteButton(): JSX.Element {
  const { t } = useTexts();
  const [opened, { open, close }] = useDisclosure();
  const [made, setMade] = useState<Invited | null>(null);
  return (
    <>
      <Button leftSection={<Icon name="add" size={18} />} onClick={open}>
        {t("invite.open")}
      </Button>
      <Modal
        opened={opened}
        onClose={close}
        onExitTransitionEnd={() => setMade(null)}
        size={made === null ? 1010 : 760}
        title={t(made === null ? "invite.title" : "invite.made")}
        closeOnClickOutside={false}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        {made === null ? (
          <InviteForm onMade={setMade} />
        ) : (
          <InviteLink invited={made} onDone={close} />
        )}
      </Modal>
    </>
  );
}

const HOURS = ["24", "72", "168", "720"] as const;

function InviteForm({ onMade }: { readonly onMade: (made: Invited) => void }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [role, setRole] = useState<Role>("operator");
  const [studies, setStudies] = useState<StudyKeys>(null);
  const [note, setNote] = useState("");
  const [hours, setHours] = useState("72");
  const make = useMutation({
    mutationFn: () => invitations.make({ role, studies, note: note.trim(), hours: Number(hours) }),
    onSuccess: (created) => {
      void queries.invalidateQueries({ queryKey: invitationsQuery.queryKey });
      onMade(created);
    },
  });
  const submit = useFormSubmit(make);
  return (
    <form onSubmit={submit}>
      <Stack>
        <RoleChoice role={role} onChange={setRole} />
        <StudiesChoice studies={studies} onChange={setStudies} />
        <Group align="start" grow>
          <TextInput
            label={t("invite.note")}
            description={t("invite.note.hint")}
            maxLength={80}
            value={note}
            onChange={(event) => setNote(event.currentTarget.value)}
          />
          <div>
            <Input.Label component="div" display="block" mb={22}>
              {t("invite.hours")}
            </Input.Label>
            <SegmentedControl
              aria-label={t("invite.hours")}
              value={hours}
              onChange={setHours}
              data={HOURS.map((value) => ({ value, label: t(`invite.hours.${value}`) }))}
            />
          </div>
        </Group>
        {make.isError && <Failure error={make.error} />}
        <Group justify="flex-end">
          <Button type="submit" loading={make.isPending}>
            {t("invite.make")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}

interface InviteLinkProps {
  readonly invited: Invited;
  readonly onDone: () => void;
}

/** The link of a new invitation, which cannot be shown a second time, not even by the server. */
function InviteLink({ invited, onDone }: InviteLinkProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <Stack>
      <Group gap="sm">
        <RoleBadge role={invited.role} />
        <span>{invited.note}</span>
      </Group>
      <Group align="end" wrap="nowrap">
        <TextInput
          label={t("invite.link")}
          readOnly
          data-autofocus
          value={invited.url}
          onFocus={(event) => event.currentTarget.select()}
          style={{ flex: 1 }}
        />
        <CopyButton value={invited.url}>
          {({ copied, copy }) => (
            <Button
              variant={copied ? "light" : "filled"}
              leftSection={<Icon name={copied ? "check" : "link"} size={17} />}
              onClick={copy}
            >
              {t(copied ? "action.copied" : "action.copy")}
            </Button>
          )}
        </CopyButton>
      </Group>
      <Notice tone="warn" icon="key">
        {t("invite.once", { date: dateTime(invited.expires_at, language) })}
      </Notice>
      {invited.only_here && (
        <Notice tone="warn">
          {t("invite.loopback", { command: lanCommand(window.location.port) })}
        </Notice>
      )}
      <Group justify="flex-end">
        <Button variant="default" onClick={onDone}>
          {t("invite.done")}
        </Button>
      </Group>
    </Stack>
  );
}
