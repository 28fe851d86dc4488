/** The state of a ledger slot as a shape: an empty ring, a half disc, a full disc with a tick. */
import type { Slot } from "@shared/api/types";
import type { JSX } from "react";

export function SlotMark({ state }: { readonly state: Slot["state"] }): JSX.Element {
  return (
    <svg width="20" height="20" viewBox="0 0 20 20" aria-hidden="true" style={{ flexShrink: 0 }}>
      {state === "free" && (
        <circle cx="10" cy="10" r="7.5" fill="none" stroke="var(--line-strong)" strokeWidth="1.5" />
      )}
      {state === "open" && (
        <>
          <circle cx="10" cy="10" r="7.5" fill="none" stroke="var(--warn-line)" strokeWidth="2" />
          <path d="M10 2.5a7.5 7.5 0 0 0 0 15Z" fill="var(--warn-line)" />
        </>
      )}
      {state === "completed" && (
        <>
          <circle cx="10" cy="10" r="8.5" fill="var(--accent)" />
          <path
            d="m6 10.3 2.7 2.7L14 7.5"
            fill="none"
            stroke="var(--on-accent)"
            strokeWidth="2"
            strokeLinecap="round"
            strokeLinejoin="round"
          />
        </>
      )}
    </svg>
  );
}
