/**
 * The search of an address belongs to its page: another page does not inherit it, and a page that is
 * opened again gets back the filters with which it was left.
 *
 * The search stands before the `#` of the route, where the router would keep it. What was chosen is
 * remembered in the browser's tab by the page's route, so for each study.
 */
import { useEffect } from "react";
import { useLocation, useSearch } from "wouter";
import { navigate as go, useHashLocation } from "wouter/use-hash-location";

type Kept = Pick<Storage, "getItem" | "setItem" | "removeItem">;

const nameOf = (route: string): string => `reembody.search${route}`;

/** What is opened by an address: one without a search gets the one that its page was left with. */
export const withOwnSearch = (to: string, kept: Kept): string =>
  to.includes("?") ? to : `${to}?${kept.getItem(nameOf(to)) ?? ""}`;

/** Remember the search of a page; one without anything in it is forgotten. */
export function keepSearch(route: string, search: string, kept: Kept): void {
  if (search === "") kept.removeItem(nameOf(route));
  else kept.setItem(nameOf(route), search);
}

const navigate: typeof go = (to, options) => go(withOwnSearch(to, sessionStorage), options);

/** The router's location: the route behind the `#`, and how to go to another. */
export function useOwnLocation(): [string, typeof go] {
  return [useHashLocation()[0], navigate];
}
useOwnLocation.hrefs = (href: string): string => `#${href}`;

/** Keep the filters of a page for its return, but those that all pages of a study share. */
export function useKeptSearch(shared: readonly string[]): void {
  const [route] = useLocation();
  const own = new URLSearchParams(useSearch());
  for (const name of shared) own.delete(name);
  const search = own.toString();
  useEffect(() => keepSearch(route, search, sessionStorage), [route, search]);
}
