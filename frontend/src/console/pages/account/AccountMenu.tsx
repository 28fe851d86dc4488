/** Who is signed in, in which role: language, appearance, password, and signing out. */
import { Button, Menu, useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
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

interface AccountMenuProps {
  readonly account: Account;
  /** Whether the user name stands on the button, or only its first letter. */
  readonly named: boolean;
}

export function AccountMenu({ account, named }: AccountMenuProps): JSX.Element {
  const { t, language, setLanguage } = useTexts();
  const { setColorScheme } = useMantineColorScheme();
  const scheme = useComputedColorScheme("light");
  const other = scheme === "light" ? "dark" : "light";
  const otherLanguage = language === "en" ? "de" : "en";
  const queries = useQueryClient();
  const [changing, change] = useDisclosure();
  return (
    <>
      <Menu position="top-end" width={280} withInitialFocusPlaceholder={false}>
        <Menu.Target>
          <Button
            variant="subtle"
            color="gray"
            size="compact-sm"
            aria-label={account.username}
            title={t("app.signedInAs", {
              name: account.username,
              role: t(`role.${account.role}`),
            })}
            className={classes.button ?? ""}
            {...(named && { rightSection: <Icon name="down" size={14} /> })}
          >
            {named ? account.username : account.username.slice(0, 1).toUpperCase()}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <div className={classes.accountButton}>
            <span className={classes.name}>{account.username}</span>
            <RoleBadge role={account.role} />
            <span>{t(`role.${account.role}.may`)}</span>
          </div>
          <Menu.Divider />
          <Menu.Item
            leftSection={<Icon name="talk" size={16} />}
            lang={otherLanguage}
            onClick={() => setLanguage(otherLanguage)}
          >
            {t("app.language")}
          </Menu.Item>
          <Menu.Item
            leftSection={<Icon name={other === "dark" ? "moon" : "sun"} size={16} />}
            onClick={() => setColorScheme(other)}
          >
            {t(`app.theme.${other}`)}
          </Menu.Item>
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
