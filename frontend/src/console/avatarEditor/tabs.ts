/** The tabs beside the body; to add one, list it here and give it a panel and a name. */
export const TABS = {
  joints: { isWide: false },
  body: { isWide: false },
  collisions: { isWide: false },
  casts: { isWide: false },
  tryout: { isWide: true },
  tuning: { isWide: false },
  versions: { isWide: true },
} as const satisfies Readonly<Record<string, { readonly isWide: boolean }>>;

export type Tab = keyof typeof TABS;
