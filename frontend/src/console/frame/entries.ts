/** What the palette finds, and in which order. */
import type { IconName } from "@shared/ui/Icon";

export const KINDS = ["pages", "studies", "sessions", "settings", "help"] as const;
export type EntryKind = (typeof KINDS)[number];

export interface Entry {
  readonly kind: EntryKind;
  /** Unique among all entries. */
  readonly id: string;
  readonly icon: IconName;
  readonly title: string;
  /** Where it belongs to; searched, too. */
  readonly about: string;
  /** Where it leads, or what it does. */
  readonly go: string | (() => void);
}

/** How many are shown of each kind: more would push the other kinds out of sight. */
const MOST = 8;

/**
 * The entries that contain every word of `query` as a part of a word, in any order and in any case;
 * those whose title begins with the first word come first. Without a query only pages and settings.
 */
export function found(entries: readonly Entry[], query: string): readonly Entry[] {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  const has = ({ title, about }: Entry): boolean => {
    const text = `${title} ${about}`.toLowerCase();
    return words.every((word) => text.includes(word));
  };
  const rank = ({ title }: Entry): number => {
    const text = title.toLowerCase();
    const [first = ""] = words;
    return text.startsWith(first)
      ? 0
      : text.includes(` ${first}`)
        ? 1
        : text.includes(first)
          ? 2
          : 3;
  };
  return KINDS.flatMap((kind) => {
    const own = entries.filter((entry) => entry.kind === kind);
    if (words.length === 0) return kind === "pages" || kind === "settings" ? own : [];
    return own
      .filter(has)
      .toSorted((a, b) => rank(a) - rank(b))
      .slice(0, MOST);
  });
}
