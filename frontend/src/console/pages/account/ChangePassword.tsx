/** Change one's own password; all other sign-ins of the account are ended. */
import { Button, Group, Modal, PasswordInput, Stack, Text } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { people } from "@shared/api/people";
import type { Account } from "@shared/api/types";
import { useMutation } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { useSingleSubmit } from "../../ui/useSingleSubmit";
import { fieldErrors, NewPassword, NOTHING_TYPED } from "./NewPassword";
import { checkPassword, isGood } from "./passwordRule";

interface ChangePasswordProps {
  readonly account: Account;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function ChangePassword({ account, opened, onClose }: ChangePasswordProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("password.change")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <PasswordForm account={account} onClose={onClose} />
    </Modal>
  );
}

function PasswordForm({ account, onClose }: Omit<ChangePasswordProps, "opened">): JSX.Element {
  const { t } = useTexts();
  const [current, setCurrent] = useState("");
  const [typed, setTyped] = useState(NOTHING_TYPED);
  const good = isGood(checkPassword(typed.password, typed.repeated, account.username));
  const change = useMutation({
    mutationFn: () => people.changePassword(current, typed.password),
    onSuccess: () => {
      notifications.show({ message: t("password.done") });
      onClose();
    },
  });
  const submit = useSingleSubmit(change);
  const errors = fieldErrors(change.error);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (good && current !== "") submit();
      }}
    >
      <Stack>
        <input type="hidden" autoComplete="username" value={account.username} readOnly />
        <PasswordInput
          data-autofocus
          label={t("password.current")}
          autoComplete="current-password"
          value={current}
          onChange={(event) => setCurrent(event.currentTarget.value)}
        />
        <NewPassword
          label={t("password.new")}
          username={account.username}
          value={typed}
          error={errors.password}
          onChange={setTyped}
        />
        <Text size="sm" c="dimmed">
          {t("password.others")}
        </Text>
        {errors.other !== null && <Failure error={errors.other} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" loading={change.isPending} disabled={!good || current === ""}>
            {t("password.change")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
