/** Who is signed in. The cookie is the server's; this page only asks whom it belongs to. */
import { accounts } from "@shared/api/endpoints";
import { isUnauthorised } from "@shared/api/errors";
import type { Account } from "@shared/api/types";
import { type QueryClient, useQuery } from "@tanstack/react-query";

const KEY = ["account"] as const;

/** The account, or null when nobody is signed in; other failures stay failures. */
export function useAccount() {
  return useQuery<Account | null>({
    queryKey: KEY,
    queryFn: async () => {
      try {
        return (await accounts.me()).account;
      } catch (error) {
        if (isUnauthorised(error)) return null;
        throw error;
      }
    },
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

/** Any answer "401" means the sign-in has ended: show the sign-in page again. */
export function forgetAccount(queries: QueryClient) {
  queries.setQueryData(KEY, null);
}
