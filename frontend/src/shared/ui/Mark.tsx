/** The product's mark: a body, and the echo that follows it. */
import type { JSX } from "react";

export function Mark({ size = 28 }: { readonly size?: number }): JSX.Element {
  return (
    <svg width={size} height={size} viewBox="0 0 32 32" aria-hidden="true">
      <g fill="none" stroke="var(--accent)" strokeWidth="2" opacity="0.55">
        <circle cx="20.5" cy="9" r="4.5" />
        <path d="M12.5 29v-5a8 8 0 0 1 16 0v5" />
      </g>
      <g fill="var(--accent)">
        <circle cx="12" cy="9" r="4.5" />
        <path d="M3 29v-5a9 9 0 0 1 18 0v5z" opacity="0.94" />
      </g>
    </svg>
  );
}
