import type { JSX } from "react";

/** A disc for a connection, an open triangle for none: shapes as well as colours. */
export function ConnectionMark({ connected }: { readonly connected: boolean }): JSX.Element {
  return (
    <svg width="10" height="10" viewBox="0 0 10 10" aria-hidden="true">
      {connected ? (
        <circle cx="5" cy="5" r="4.5" fill="var(--accent)" />
      ) : (
        <path d="M5 1 9.5 9.2H.5Z" fill="none" stroke="currentColor" strokeWidth="1.4" />
      )}
    </svg>
  );
}
