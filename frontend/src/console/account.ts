/** Who is signed in. The cookie is the server's; this page only asks whom it belongs to. */
import { accounts } from "@shared/api/endpoints";
import { isUnauthorised } from "@shared/api/request";
import type { Account } from "@shared/api/types";
import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";

const KEY = ["account"] as const;
/** Whose sign-in ended while the page was in use, and whose page is kept until it goes on. */
const ENDED = ["account", "ended"] as const;

/** The account, or null when nobody is signed in. */
export function useAccount() {
  return useQuery<Account | null>({
    queryKey: KEY,
    queryFn: async () => (await accounts.me()).account,
    staleTime: 60_000,
  });
}

/** Who was signed in when the sign-in ended by itself; null else. */
export function useEnded(): Account | null {
  const ended = useQuery<Account | null>({
    queryKey: ENDED,
    queryFn: () => null,
    initialData: null,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: Number.POSITIVE_INFINITY,
  });
  return ended.data;
}

export async function signIn(queries: QueryClient, username: string, password: string) {
  const { account } = await accounts.login(username, password);
  begin(queries, account);
}

/** Somebody has a sign-in now; nothing of anybody else stays in the page's memory. */
export function begin(queries: QueryClient, account: Account): void {
  const before = queries.getQueryData<Account | null>(ENDED);
  if (before?.id !== account.id) forget(queries);
  queries.setQueryData(ENDED, null);
  queries.setQueryData(KEY, account);
  // The same person goes on where they were; what they see may have changed meanwhile.
  void queries.invalidateQueries({ predicate: isData });
}

/** Leave nothing of this person's data in the page's memory. */
export async function signOut(queries: QueryClient) {
  await accounts.logout().catch(() => undefined);
  forget(queries);
  queries.setQueryData(ENDED, null);
  queries.setQueryData(KEY, null);
}

const isData = ({ queryKey }: { readonly queryKey: readonly unknown[] }): boolean =>
  queryKey[0] !== KEY[0];

function forget(queries: QueryClient): void {
  queries.removeQueries({ predicate: isData });
  queries.getMutationCache().clear();
}

/** Ask who is signed in, because something hints that nobody is; a lost line says nothing. */
export async function lookAgain(queries: QueryClient): Promise<void> {
  const who = await accounts.me().catch(() => undefined);
  if (who?.account === null) end(queries);
}

/** Any answer "nobody is signed in" means that the sign-in has ended: show its page again. */
export function useSignInAgain(): void {
  const queries = useQueryClient();
  useEffect(() => {
    // Only an error that has just come: an old one is still there when the same person goes on.
    const look = (news: { readonly type: string; readonly action?: unknown }) => {
      const action = news.action as { readonly type: string; readonly error?: unknown } | undefined;
      if (news.type !== "updated" || action?.type !== "error") return;
      if (isUnauthorised(action.error)) end(queries);
    };
    const stops = [
      queries.getQueryCache().subscribe(look),
      queries.getMutationCache().subscribe(look),
    ];
    return () => {
      for (const stop of stops) stop();
    };
  }, [queries]);
}

function end(queries: QueryClient): void {
  const account = queries.getQueryData<Account | null>(KEY);
  if (account != null) queries.setQueryData(ENDED, account);
  queries.setQueryData(KEY, null);
}

/** `account:admin` is admin. */
export const nameOf = (actor: string): string => actor.replace("account:", "");
