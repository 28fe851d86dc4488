/**
 * The console: signed out it is one page, signed in a header and the page the address names.
 *
 * Where a sign-in ends by itself, the page it was used on is hidden, not thrown away: the same
 * person goes on with what they were writing, anybody else begins afresh.
 */
import { Center, Loader } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { Activity, type JSX, Suspense, useEffect } from "react";
import { Router } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { useAccount, useEnded, useSignInAgain } from "./account";
import { Failure } from "./errors";
import { Header } from "./Header";
import { useHelpKey } from "./help/useHelpKey";
import { useTexts } from "./i18n";
import { JoinPage } from "./pages/join/JoinPage";
import { Login } from "./pages/Login";
import { may } from "./permissions";
import { Routes } from "./Routes";
import classes from "./Shell.module.css";
import { TryoutBar } from "./tour/TryoutBar";

const INVITATION = /^\/join\/(.+)$/;

export function Console(): JSX.Element {
  const account = useAccount();
  const ended = useEnded();
  const [address] = useHashLocation();
  const token = INVITATION.exec(address)?.[1];
  useOpenDialogsHidden(account.data === null);
  // What is known stays on the page while the server does not answer.
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

/** Dialogs are drawn beside the page, so they have to be hidden with it. */
function useOpenDialogsHidden(hidden: boolean): void {
  useEffect(() => {
    document.body.toggleAttribute("data-signed-out", hidden);
  }, [hidden]);
}

/** The signed-in console: its head, the page of the address, and what goes on behind it. */
function Shell({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  useSignInAgain();
  useHelpKey();
  return (
    <Router hook={useHashLocation}>
      <button type="button" className={classes.skip} onClick={focusMain}>
        {t("app.skip")}
      </button>
      <Header account={account} />
      <main id="main" tabIndex={-1}>
        <Suspense fallback={<Waiting />}>
          <Routes account={account} />
        </Suspense>
      </main>
      {may(account.role, "tryout") && <TryoutBar />}
    </Router>
  );
}

const Waiting = (): JSX.Element => (
  <Center mih={320}>
    <Loader />
  </Center>
);

/** The address after `#` belongs to the router, so skipping moves the focus itself. */
function focusMain(): void {
  document.getElementById("main")?.focus();
}
