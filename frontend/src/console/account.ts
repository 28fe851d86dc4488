/** The signed-in account. The cookie is the server's; this page only queries whose it is. */
import { accounts } from "@shared/api/endpoints";
import { isUnauthorised, setAccountOfPage } from "@shared/api/request";
import type { Account } from "@shared/api/types";
import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { onSameAccount, tellOtherTabs } from "./otherTabs";

const KEY = ["account"] as const;
/** The account whose sign-in expired while the page was in use, and whose page is kept for it. */
const EXPIRED = ["account", "ended"] as const;

/** The account, or null when nobody is signed in. */
export function useAccount() {
  return useQuery<Account | null>({
    queryKey: KEY,
    queryFn: async ({ client }) => {
      const { account } = await accounts.me();
      if (account === null) keepExpired(client);
      else setAccountOfPage(account.id);
      return account;
    },
    staleTime: 60_000,
  });
}

/** The account whose sign-in has expired; null if none has. */
export function useExpiredAccount(): Account | null {
  const ended = useQuery<Account | null>({
    queryKey: EXPIRED,
    queryFn: () => null,
    initialData: null,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: Number.POSITIVE_INFINITY,
  });
  return ended.data;
}

export async function signIn(queries: QueryClient, username: string, password: string) {
  const { account } = await accounts.login(username, password);
  startSession(queries, account);
}

/**
 * Start a session of the console for an account; data of any other account are removed from memory.
 */
export function startSession(queries: QueryClient, account: Account): void {
  const before = queries.getQueryData<Account | null>(EXPIRED);
  if (before?.id !== account.id) forget(queries);
  setAccountOfPage(account.id);
  tellOtherTabs(account.id);
  queries.setQueryData(EXPIRED, null);
  queries.setQueryData(KEY, account);
  // The same person continues where they were; the data may have changed meanwhile.
  void queries.invalidateQueries({ predicate: isData });
}

/** Sign out, and remove this person's data from the page's memory. */
export async function signOut(queries: QueryClient) {
  await accounts.logout().catch(() => undefined);
  forget(queries);
  setAccountOfPage(null);
  tellOtherTabs(null);
  queries.setQueryData(EXPIRED, null);
  queries.setQueryData(KEY, null);
}

const isData = ({ queryKey }: { readonly queryKey: readonly unknown[] }): boolean =>
  queryKey[0] !== KEY[0];

function forget(queries: QueryClient): void {
  queries.removeQueries({ predicate: isData });
  queries.getMutationCache().clear();
}

/**
 * Check whether the sign-in still exists, because something suggests that it does not; a network
 * error proves nothing.
 */
export async function checkSignIn(queries: QueryClient): Promise<void> {
  const who = await accounts.me().catch(() => undefined);
  if (who?.account === null) expire(queries);
}

/** Continue at once if the same person has signed in again in another tab. */
export function useSignInElsewhere(): void {
  const queries = useQueryClient();
  useEffect(
    () => onSameAccount(() => void queries.invalidateQueries({ queryKey: KEY, exact: true })),
    [queries],
  );
}

/** Show the sign-in page again as soon as any request fails because nobody is signed in. */
export function useExpiryDetection(): void {
  const queries = useQueryClient();
  useEffect(() => {
    // Only new errors: an old one is still in the cache when the same person continues.
    const checkError = (event: { readonly type: string; readonly action?: unknown }) => {
      const action = event.action as
        | { readonly type: string; readonly error?: unknown }
        | undefined;
      if (event.type !== "updated" || action?.type !== "error") return;
      if (isUnauthorised(action.error)) expire(queries);
    };
    const stops = [
      queries.getQueryCache().subscribe(checkError),
      queries.getMutationCache().subscribe(checkError),
    ];
    return () => {
      for (const stop of stops) stop();
    };
  }, [queries]);
}

/** How often an open page checks whether somebody has ended its sign-in, ms. */
const CHECK_EVERY_MS = 10_000;

/** Check again and again that the sign-in still exists: most pages have no live feed that ends. */
export function useSignInChecks(): void {
  const queries = useQueryClient();
  useEffect(() => {
    const check = () => {
      if (!document.hidden) void checkSignIn(queries);
    };
    const checks = window.setInterval(check, CHECK_EVERY_MS);
    document.addEventListener("visibilitychange", check);
    return () => {
      window.clearInterval(checks);
      document.removeEventListener("visibilitychange", check);
    };
  }, [queries]);
}

function expire(queries: QueryClient): void {
  keepExpired(queries);
  queries.setQueryData(KEY, null);
}

/** Remember whose page is kept until they sign in again. */
function keepExpired(queries: QueryClient): void {
  const account = queries.getQueryData<Account | null>(KEY);
  if (account != null) queries.setQueryData(EXPIRED, account);
}

/** The name of an actor: `account:admin` is admin. */
export const nameOf = (actor: string): string => actor.replace("account:", "");
