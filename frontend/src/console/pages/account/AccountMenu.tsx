/** Who is signed in, in which role, and the button for signing out. */
import { Button, Menu } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import type { Account } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { signOut } from "../../account";
import { useTexts } from "../../i18n";
import { RoleBadge } from "../../ui/badges";
import classes from "./AccountMenu.module.css";
import { ChangePassword } from "./ChangePassword";

export function AccountMenu({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [changing, change] = useDisclosure();
  return (
    <>
      <Menu position="bottom-end" width={280} withInitialFocusPlaceholder={false}>
        <Menu.Target>
          <Button
            variant="subtle"
            color="gray"
            size="compact-sm"
            rightSection={<Icon name="down" size={14} />}
          >
            {account.username}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <div className={classes.accountButton}>
            <span className={classes.name}>{account.username}</span>
            <RoleBadge role={account.role} />
            <span>{t(`role.${account.role}.may`)}</span>
          </div>
          <Menu.Divider />
          <Menu.Item leftSection={<Icon name="key" size={16} />} onClick={change.open}>
            {t("password.change")}
          </Menu.Item>
          <Menu.Item
            leftSection={<Icon name="forward" size={16} />}
            onClick={() => void signOut(queries)}
          >
            {t("app.logout")}
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <ChangePassword account={account} opened={changing} onClose={change.close} />
    </>
  );
}
