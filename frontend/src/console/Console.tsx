/** The console: signed out it is one page, signed in a header and the page the address names. */
import { Center, Loader } from "@mantine/core";
import type { JSX } from "react";
import { useAccount } from "./account";
import { Failure } from "./errors";
import { Login } from "./pages/Login";
import { Shell } from "./Shell";

export function Console(): JSX.Element {
  const account = useAccount();
  if (account.isPending) {
    return (
      <Center mih="100dvh">
        <Loader />
      </Center>
    );
  }
  if (account.isError) {
    return (
      <Center mih="100dvh" p="xl">
        <Failure error={account.error} onRetry={() => void account.refetch()} />
      </Center>
    );
  }
  return account.data === null ? <Login /> : <Shell account={account.data} />;
}
