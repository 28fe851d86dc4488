/**
 * How the tablet's service worker handles a request, and which of its caches it deletes.
 *
 *     page    the tablet's page: from the server, so that it is the newest; offline from the cache
 *     asset   a file whose name contains its content's hash: from the cache, otherwise from the
 *     server
 *     leave   everything else, above all every response of /api: not touched and never cached
 */

export type Plan = "page" | "asset" | "leave";

/** Prepended to the worker by the build: the files of the page, and a hash of all of them. */
export interface Build {
  readonly version: string;
  readonly page: string;
  /** The first one is the page's own script. */
  readonly files: readonly string[];
}

interface PlannedRequest {
  readonly method: string;
  readonly url: string;
  readonly mode: string;
}

export function planFor({ method, url, mode }: PlannedRequest, origin: string, page: string): Plan {
  const address = new URL(url);
  if (method !== "GET" || address.origin !== origin) return "leave";
  // With or without a slash at its end.
  if (mode === "navigate") return address.pathname.replace(/\/$/, "") === page ? "page" : "leave";
  return address.pathname.startsWith("/assets/") ? "asset" : "leave";
}

const PREFIX = "reembody-tablet-";

export const cacheName = (version: string): string => `${PREFIX}${version}`;

/**
 * The caches to delete when the worker with cache `own` takes over; `names` are in order of
 * creation.
 *
 * The newest of the others is kept: a page of that build may still be open and need a part that it
 * has not loaded yet.
 */
export function outdated(names: readonly string[], own: string): readonly string[] {
  return names.filter((name) => name.startsWith(PREFIX) && name !== own).slice(0, -1);
}
