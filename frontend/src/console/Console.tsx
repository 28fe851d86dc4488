/**
 * The console: the sign-in page, or the frame with the page that the address names.
 *
 * When a sign-in expires, the page it was used on is hidden rather than discarded: the same person
 * can continue what they were writing, anybody else starts with a fresh page. So do all tabs when
 * another account signs in in one of them.
 */
import { Center, Loader } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { Boundary } from "@shared/ui/Boundary";
import { useQueryClient } from "@tanstack/react-query";
import { Activity, type JSX, Suspense, useEffect } from "react";
import { Router, useLocation } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import {
  useAccount,
  useExpiredAccount,
  useExpiryDetection,
  useSignInChecks,
  useSignInElsewhere,
} from "./account";
import { Failure } from "./errors";
import { Frame } from "./frame/Frame";
import { useOwnLocation } from "./frame/ownSearch";
import { useHelpKey } from "./help/useHelpKey";
import { useTexts } from "./i18n";
import { useAccountChanged } from "./otherTabs";
import { JoinPage } from "./pages/join/JoinPage";
import { Login } from "./pages/Login";
import { may } from "./permissions";
import { Routes } from "./Routes";
import classes from "./Shell.module.css";
import { TryoutBar } from "./tour/TryoutBar";

const INVITATION = /^\/join\/(.+)$/;

export function Console(): JSX.Element {
  // The page is taken down before it is loaded again, so that nothing on it asks whether to leave.
  return useAccountChanged() ? <Reload /> : <ConsoleOfAccount />;
}

function Reload(): JSX.Element {
  const queries = useQueryClient();
  useEffect(() => {
    queries.clear();
    window.location.reload();
  }, [queries]);
  return <Waiting />;
}

function ConsoleOfAccount(): JSX.Element {
  const account = useAccount();
  const ended = useExpiredAccount();
  const [address] = useHashLocation();
  const token = INVITATION.exec(address)?.[1];
  useOpenDialogsHidden(account.data === null);
  useSignInElsewhere();
  // Cached data stay on the page while the server does not answer.
  if (account.data === undefined) {
    return (
      <Center mih="100dvh" p="xl">
        {account.isError ? (
          <Failure error={account.error} onRetry={() => void account.refetch()} />
        ) : (
          <Loader />
        )}
      </Center>
    );
  }
  if (token !== undefined) return <JoinPage key={token} token={token} account={account.data} />;
  const shown = account.data ?? ended;
  return (
    <>
      {account.data === null && <Login ended={ended} />}
      {shown !== null && (
        <Activity key={shown.id} mode={account.data === null ? "hidden" : "visible"}>
          <Shell account={shown} />
        </Activity>
      )}
    </>
  );
}

/** Hide open dialogs along with the page, since they are rendered outside of it. */
function useOpenDialogsHidden(hidden: boolean): void {
  useEffect(() => {
    document.body.toggleAttribute("data-signed-out", hidden);
  }, [hidden]);
}

/** The signed-in console: its frame, the page of the address, and background tasks. */
function Shell({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  useExpiryDetection();
  useSignInChecks();
  useHelpKey();
  return (
    <Router hook={useOwnLocation}>
      <button type="button" className={classes.skip} onClick={focusMain}>
        {t("app.skip")}
      </button>
      <Frame account={account}>
        {may(account.role, "tryout") && <TryoutBar />}
        <Page account={account} />
      </Frame>
      <FocusOnPage />
    </Router>
  );
}

/** The page of the address; one that cannot be shown leaves the sidebar usable. */
function Page({ account }: { readonly account: Account }): JSX.Element {
  const [address] = useLocation();
  return (
    <Boundary place={address}>
      <Suspense fallback={<Waiting />}>
        <Routes account={account} />
      </Suspense>
    </Boundary>
  );
}

/**
 * With every page the focus goes to it, unless something on it has the focus already: otherwise Tab
 * would go through the whole navigation again.
 */
function FocusOnPage(): null {
  const [address] = useLocation();
  // biome-ignore lint/correctness/useExhaustiveDependencies: whenever the address changes
  useEffect(() => {
    const focused = document.activeElement;
    const isFree = focused === null || focused === document.body || focused.closest("nav") !== null;
    if (isFree) document.getElementById("main")?.focus({ preventScroll: true });
  }, [address]);
  return null;
}

const Waiting = (): JSX.Element => (
  <Center mih={320}>
    <Loader />
  </Center>
);

/** The address after `#` belongs to the router, so the skip link moves the focus with a script. */
function focusMain(): void {
  document.getElementById("main")?.focus();
}
