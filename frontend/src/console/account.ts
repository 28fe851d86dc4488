/** Who is signed in. The cookie is the server's; this page only asks whom it belongs to. */
import { accounts } from "@shared/api/endpoints";
import { isUnauthorised } from "@shared/api/errors";
import type { Account } from "@shared/api/types";
import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";

const KEY = ["account"] as const;

/** The account, or null when nobody is signed in. */
export function useAccount() {
  return useQuery<Account | null>({
    queryKey: KEY,
    queryFn: async () => (await accounts.me()).account,
    staleTime: 60_000,
  });
}

export async function signIn(queries: QueryClient, username: string, password: string) {
  const { account } = await accounts.login(username, password);
  queries.setQueryData(KEY, account);
}

/** Leave nothing of this person's data in the page's memory. */
export async function signOut(queries: QueryClient) {
  await accounts.logout().catch(() => undefined);
  queries.clear();
  queries.setQueryData(KEY, null);
}

/** Any answer "nobody is signed in" means that the sign-in has ended: show its page again. */
export function useSignInAgain(): void {
  const queries = useQueryClient();
  useEffect(() => {
    const look = (error: unknown) => {
      if (isUnauthorised(error)) queries.setQueryData(KEY, null);
    };
    const stops = [
      queries.getQueryCache().subscribe(({ query }) => look(query.state.error)),
      queries.getMutationCache().subscribe(({ mutation }) => look(mutation?.state.error)),
    ];
    return () => {
      for (const stop of stops) stop();
    };
  }, [queries]);
}
