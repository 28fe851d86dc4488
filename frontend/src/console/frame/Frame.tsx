/**
 * The frame of every page: the sidebar beside it, or a bar above it in a narrow window.
 *
 * In a wide window the sidebar has names, in a middling one only icons, and so on pages that need
 * the width, unless somebody has chosen otherwise.
 */
import { ActionIcon, Drawer, Loader } from "@mantine/core";
import { useDisclosure, useLocalStorage, useMediaQuery } from "@mantine/hooks";
import type { Account } from "@shared/api/types";
import { Boundary } from "@shared/ui/Boundary";
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import { type JSX, lazy, type ReactNode, Suspense, useEffect } from "react";
import { Link, useLocation } from "wouter";
import { DemoStrip } from "../home/DemoStrip";
import { useTexts } from "../i18n";
import classes from "./Frame.module.css";
import { isWide } from "./places";
import { Sidebar } from "./Sidebar";

// Loaded with its index of the help when it is first opened.
const Palette = lazy(async () => ({ default: (await import("./Palette")).Palette }));

const NARROW = "(max-width: 699px)";
const ROOMY = "(min-width: 1200px)";
const VAST = "(min-width: 1600px)";
/** Matched in the first drawing already, so that nothing is moved by a second one. */
const AT_ONCE = { getInitialValueInEffect: false };

export function Frame({
  account,
  children,
}: {
  readonly account: Account;
  readonly children: ReactNode;
}): JSX.Element {
  const [address] = useLocation();
  const [searching, search] = useDisclosure();
  const narrow = useMediaQuery(NARROW, false, AT_ONCE) ?? false;
  const roomy = useMediaQuery(ROOMY, true, AT_ONCE) ?? true;
  const vast = useMediaQuery(VAST, false, AT_ONCE) ?? false;
  const wide = isWide(address);
  const [chosen, setChosen] = useLocalStorage<{ readonly [kind: string]: boolean }>({
    key: "reembody.sidebar.names",
    defaultValue: {},
    getInitialValueInEffect: false,
  });
  const kind = wide ? "wide" : "list";
  const named = chosen[kind] ?? (wide ? vast : roomy);
  useSearchKey(search.toggle);
  const sidebar = (options: { readonly named: boolean; readonly onToggle?: () => void }) => (
    <Sidebar account={account} onSearch={search.open} {...options} />
  );
  return (
    <div className={classes.frame} data-narrow={narrow || undefined}>
      {narrow ? (
        <TopBar onSearch={search.open}>{sidebar({ named: true })}</TopBar>
      ) : (
        <div className={classes.beside} data-icons={named ? undefined : true}>
          {sidebar({ named, onToggle: () => setChosen({ ...chosen, [kind]: !named }) })}
        </div>
      )}
      <main id="main" tabIndex={-1}>
        <DemoStrip />
        {children}
      </main>
      {searching && (
        <Boundary place={address}>
          <Suspense fallback={<Loader className={classes.loading ?? ""} />}>
            <Palette account={account} address={address} onClose={search.close} />
          </Suspense>
        </Boundary>
      )}
    </div>
  );
}

/** In a narrow window: the name, the search, and a button that opens the sidebar as a drawer. */
function TopBar({
  onSearch,
  children,
}: {
  readonly onSearch: () => void;
  readonly children: ReactNode;
}): JSX.Element {
  const { t } = useTexts();
  const [address] = useLocation();
  const [opened, drawer] = useDisclosure();
  // A choice leads to another page, which the drawer must not cover.
  // biome-ignore lint/correctness/useExhaustiveDependencies: closes whenever the address changes
  useEffect(drawer.close, [address]);
  return (
    <header className={classes.top}>
      <ActionIcon
        variant="subtle"
        color="gray"
        size="lg"
        aria-label={t("frame.open")}
        onClick={drawer.open}
      >
        <Icon name="menu" />
      </ActionIcon>
      <Link href="/" className={classes.brand ?? ""}>
        <Mark size={24} />
        {t("app.name")}
      </Link>
      <ActionIcon
        variant="subtle"
        color="gray"
        size="lg"
        ml="auto"
        aria-label={t("frame.search.long")}
        onClick={onSearch}
      >
        <Icon name="search" />
      </ActionIcon>
      <Drawer
        opened={opened}
        onClose={drawer.close}
        size={280}
        withCloseButton={false}
        title={t("frame.label")}
        styles={{ body: { padding: 0, height: "100%" } }}
      >
        {children}
      </Drawer>
    </header>
  );
}

/** Ctrl+K, or Cmd+K on a Mac, opens and closes the search, also while something is typed. */
function useSearchKey(onKey: () => void): void {
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.key.toLowerCase() !== "k" || !(event.ctrlKey || event.metaKey)) return;
      if (event.altKey || event.shiftKey) return;
      event.preventDefault();
      onKey();
    };
    document.addEventListener("keydown", onKeyDown);
    return () => document.removeEventListener("keydown", onKeyDown);
  }, [onKey]);
}
