/** The link of a fresh invitation: nobody, not even the server, can show it again. */
import { Button, CopyButton, Group, Stack, TextInput } from "@mantine/core";
import type { Invited } from "@shared/api/people";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { networkQuery } from "../../queries";
import { RoleBadge } from "../../ui/RoleBadge";

interface InviteLinkProps {
  readonly made: Invited;
  readonly onDone: () => void;
}

export function InviteLink({ made, onDone }: InviteLinkProps): JSX.Element {
  const { t, language } = useTexts();
  const loopback = useQuery(networkQuery).data?.mode === "loopback";
  return (
    <Stack>
      <Group gap="sm">
        <RoleBadge role={made.role} />
        <span>{made.note}</span>
      </Group>
      <Group align="end" wrap="nowrap">
        <TextInput
          label={t("invite.link")}
          readOnly
          data-autofocus
          value={made.url}
          onFocus={(event) => event.currentTarget.select()}
          style={{ flex: 1 }}
        />
        <CopyButton value={made.url}>
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
        {t("invite.once", { date: dateTime(made.expires_at, language) })}
      </Notice>
      {loopback && <Notice tone="info">{t("invite.loopback")}</Notice>}
      <Group justify="flex-end">
        <Button variant="default" onClick={onDone}>
          {t("invite.done")}
        </Button>
      </Group>
    </Stack>
  );
}
