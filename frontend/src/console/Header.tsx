/** The console's header: navigation, language, colour scheme, help and the account menu. */
import { ActionIcon, Button, useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
import type { Role } from "@shared/api/people";
import type { Account } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { DownloadsButton } from "./downloads/DownloadsButton";
import { type Key, useTexts } from "./i18n";
import { AccountMenu } from "./pages/account/AccountMenu";
import { may, type Permission } from "./permissions";
import classes from "./Shell.module.css";
import { HelpMenu } from "./tour/HelpMenu";

export function Header({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  return (
    <nav className={classes.header} aria-label={t("app.name")}>
      <Link href="/" className={classes.brand ?? ""}>
        <Mark size={26} />
        {t("app.name")}
      </Link>
      <div className={classes.tools}>
        <Places role={account.role} />
        <LanguageButton />
        {may(account.role, "compare") && <DownloadsButton />}
        <HelpMenu />
        <AppearanceButton />
        <AccountMenu account={account} />
      </div>
    </nav>
  );
}

interface Place {
  readonly href: string;
  readonly icon: IconName;
  readonly name: Key;
  /** The permission required to see it; without one it is shown to everybody. */
  readonly permission?: Permission;
}

const PLACES: readonly Place[] = [
  { href: "/instruments", icon: "form", name: "instruments.title" },
  { href: "/captures", icon: "walk", name: "captures.title" },
  { href: "/bodies", icon: "body", name: "bodies.title" },
  { href: "/avatars", icon: "joint", name: "avatars.title" },
  { href: "/walking", icon: "foot", name: "walking.title" },
  { href: "/equipment", icon: "headset", name: "equipment.title" },
  { href: "/network", icon: "link", name: "network.title", permission: "network" },
  { href: "/storage", icon: "chart", name: "storage.title", permission: "storage" },
  { href: "/people", icon: "people", name: "people.title", permission: "people" },
];

function Places({ role }: { readonly role: Role }): JSX.Element {
  const { t } = useTexts();
  const [address] = useLocation();
  const isHere = ({ href }: Place) => address === href || address.startsWith(`${href}/`);
  return (
    <>
      {PLACES.filter(({ permission }) => permission === undefined || may(role, permission)).map(
        (place) => (
          <Button
            key={place.href}
            component={Link}
            href={place.href}
            aria-current={isHere(place) ? "page" : undefined}
            variant={isHere(place) ? "light" : "subtle"}
            {...(isHere(place) ? {} : { color: "gray" })}
            fw={isHere(place) ? 560 : 450}
            size="compact-sm"
            leftSection={<Icon name={place.icon} size={16} />}
          >
            {t(place.name)}
          </Button>
        ),
      )}
    </>
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
