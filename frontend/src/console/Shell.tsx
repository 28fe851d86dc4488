/** The signed-in console: its head, the page of the address, and what goes on behind it. */
import { Center, Loader } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { type JSX, Suspense } from "react";
import { Router } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { useSignInAgain } from "./account";
import { Header } from "./Header";
import { useTexts } from "./i18n";
import { may } from "./may";
import { Routes } from "./Routes";
import classes from "./Shell.module.css";
import { TryoutBar } from "./tour/TryoutBar";

export function Shell({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  useSignInAgain();
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
