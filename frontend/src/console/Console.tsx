/**
 * The console: signed out it is one page, signed in a header and the page the address names.
 *
 * Where a sign-in ends by itself, the page it was used on is hidden, not thrown away: the same
 * person goes on with what they were writing, anybody else begins afresh.
 */
import { Center, Loader } from "@mantine/core";
import { Activity, type JSX, useEffect } from "react";
import { useHashLocation } from "wouter/use-hash-location";
import { useAccount, useEnded } from "./account";
import { Failure } from "./errors";
import { JoinPage } from "./pages/join/JoinPage";
import { Login } from "./pages/Login";
import { Shell } from "./Shell";

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
