/** Header and routes of the signed-in console. */
import {
  ActionIcon,
  Button,
  Menu,
  useComputedColorScheme,
  useMantineColorScheme,
} from "@mantine/core";
import type { Account } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import { useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link, Route, Router, Switch } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { signOut, useSignInAgain } from "./account";
import { SessionPage } from "./cockpit/SessionPage";
import { useTexts } from "./i18n";
import { NetworkPage } from "./pages/network/NetworkPage";
import { StudiesPage } from "./pages/Studies";
import { StudyPage } from "./pages/study/StudyPage";
import classes from "./Shell.module.css";

export function Shell({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  useSignInAgain();
  return (
    <Router hook={useHashLocation}>
      <button type="button" className={classes.skip} onClick={focusMain}>
        {t("app.skip")}
      </button>
      <nav className={classes.header} aria-label={t("app.name")}>
        <Link href="/" className={classes.brand ?? ""}>
          <Mark size={26} />
          {t("app.name")}
        </Link>
        <div className={classes.tools}>
          <NetworkLink />
          <LanguageButton />
          <AppearanceButton />
          <AccountMenu account={account} />
        </div>
      </nav>
      <main id="main" tabIndex={-1}>
        <Switch>
          <Route path="/sessions/:id">{({ id }) => <SessionPage key={id} id={id} />}</Route>
          <Route path="/network">
            <div className={classes.main}>
              <NetworkPage />
            </div>
          </Route>
          <Route path="/studies/:key/:tab?">
            {({ key, tab }) => (
              <div className={classes.main}>
                <StudyPage studyKey={key} tab={tab} />
              </div>
            )}
          </Route>
          <Route>
            <div className={classes.main}>
              <StudiesPage />
            </div>
          </Route>
        </Switch>
      </main>
    </Router>
  );
}

/** The address after `#` belongs to the router, so skipping moves the focus itself. */
function focusMain(): void {
  document.getElementById("main")?.focus();
}

function NetworkLink(): JSX.Element {
  const { t } = useTexts();
  return (
    <Button
      component={Link}
      href="/network"
      variant="subtle"
      color="gray"
      fw={450}
      size="compact-sm"
      leftSection={<Icon name="link" size={16} />}
    >
      {t("network.title")}
    </Button>
  );
}

function LanguageButton(): JSX.Element {
  const { t, language, setLanguage } = useTexts();
  return (
    <Button
      variant="subtle"
      color="gray"
      fw={450}
      size="compact-sm"
      lang={language === "en" ? "de" : "en"}
      onClick={() => setLanguage(language === "en" ? "de" : "en")}
    >
      {t("app.language")}
    </Button>
  );
}

function AppearanceButton(): JSX.Element {
  const { t } = useTexts();
  const { setColorScheme } = useMantineColorScheme();
  const scheme = useComputedColorScheme("light");
  const other = scheme === "light" ? "dark" : "light";
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      size="lg"
      aria-label={t(`app.theme.${other}`)}
      onClick={() => setColorScheme(other)}
    >
      <Icon name={other === "dark" ? "moon" : "sun"} />
    </ActionIcon>
  );
}

function AccountMenu({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  return (
    <Menu position="bottom-end" width={260}>
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
        <Menu.Label>
          {t("app.signedInAs", { name: account.username, role: account.role })}
        </Menu.Label>
        <Menu.Item onClick={() => void signOut(queries)}>{t("app.logout")}</Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
