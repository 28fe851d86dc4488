/**
 * What the tablet's service worker does with a request, and which of its caches it gives up.
 *
 *     page    the tablet's page: from the server, so that it is the newest, or else as it was kept
 *     asset   a file whose name holds its content's hash: as it was kept, or else from the server
 *     leave   everything else, and above all every answer of /api: not touched and never kept
 */
export type Plan = "page" | "asset" | "leave";

/** Put in front of the worker by the build: what belongs to the page, and the hash of all of it. */
export interface Build {
  readonly version: string;
  readonly page: string;
  /** The first one is the page's own script. */
  readonly files: readonly string[];
}

interface Asked {
  readonly method: string;
  readonly url: string;
  readonly mode: string;
}

export function planFor({ method, url, mode }: Asked, origin: string, page: string): Plan {
  const address = new URL(url);
  if (method !== "GET" || address.origin !== origin) return "leave";
  if (mode === "navigate") return address.pathname === page ? "page" : "leave";
  return address.pathname.startsWith("/assets/") ? "asset" : "leave";
}

const PREFIX = "reembody-tablet-";

export const cacheName = (version: string): string => `${PREFIX}${version}`;

/**
 * The caches to delete when `own` takes over, of all in the order in which they were made.
 *
 * The newest of the others stays: a page of that build may be open still and want a part it has not
 * loaded yet.
 */
export function outdated(names: readonly string[], own: string): readonly string[] {
  return names.filter((name) => name.startsWith(PREFIX) && name !== own).slice(0, -1);
}
