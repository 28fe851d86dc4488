/**
 * Unsaved work on avatars, kept in the browser. Every opening of the editor has a slot of its own,
 * so that neither another tab nor a later visit overwrites what is kept.
 */
import { type AvatarFile, differences } from "./axes";

const PREFIX = "reembody.draft.avatar.";

/** Work that an earlier visit or another tab has left. */
export interface KeptDraft {
  /** Its key in the storage. */
  readonly slot: string;
  /** What is stored, as it is. */
  readonly text: string;
  /** When it was last changed, ISO 8601; null if an earlier release stored it. */
  readonly at: string | null;
  /** The content hash of the version that it began from; null if an earlier release stored it. */
  readonly baseHash: string | null;
  /** Null if it cannot be read. */
  readonly configuration: AvatarFile | null;
}

/** What is kept of the work of one opening of the editor. */
export interface Draft {
  /** The account whose work it is: on a shared computer others are not offered it. */
  readonly by: string;
  readonly baseHash: string;
  readonly configuration: AvatarFile;
  readonly at: string;
}

/** The slot of one opening of the editor; `id` is unlike that of any other. */
export const slotOf = (avatarKey: string, id: string): string => `${PREFIX}${avatarKey}/${id}`;

/** What an account has left of an avatar, newest first, but for the slot of this opening. */
export function keptDrafts(
  storage: Storage,
  avatarKey: string,
  own: string,
  account: string,
): KeptDraft[] {
  const first = PREFIX + avatarKey;
  const slots = Array.from({ length: storage.length }, (_, index) => storage.key(index) ?? "");
  return slots
    .filter((slot) => slot !== own && (slot === first || slot.startsWith(`${first}/`)))
    .flatMap((slot) => readDraft(slot, storage.getItem(slot) ?? "", account))
    .sort((a, b) => (b.at ?? "").localeCompare(a.at ?? ""));
}

/** Keep work; false if the storage is full or forbidden, which must not prevent editing. */
export function keepDraft(storage: Storage, slot: string, draft: Draft): boolean {
  try {
    storage.setItem(slot, JSON.stringify(draft));
    return true;
  } catch {
    return false;
  }
}

/** How many values of a kept draft differ from a version; null if it cannot be read. */
export function changesIn(draft: KeptDraft, base: AvatarFile): number | null {
  if (draft.configuration === null) return null;
  try {
    return differences(base, draft.configuration).length;
  } catch {
    return null;
  }
}

/**
 * The newest version with the content that a draft began from, among those of its avatar, newest
 * first; null if none has it.
 */
export function startOf(
  draft: KeptDraft,
  versions: readonly { readonly number: number; readonly content_hash: string }[],
): number | null {
  return versions.find(({ content_hash }) => content_hash === draft.baseHash)?.number ?? null;
}

/** One draft, or none if it is another account's. */
function readDraft(slot: string, text: string, account: string): KeptDraft[] {
  const nothing = { slot, text, at: null, baseHash: null, configuration: null };
  try {
    const stored = JSON.parse(text) as Partial<Record<keyof Draft, unknown>> | null;
    if (typeof stored?.by === "string" && stored.by !== account) return [];
    const { at, baseHash, configuration } = stored ?? {};
    const isTree = typeof configuration === "object" && configuration !== null;
    return [
      {
        ...nothing,
        at: typeof at === "string" && !Number.isNaN(Date.parse(at)) ? at : null,
        baseHash: typeof baseHash === "string" ? baseHash : null,
        configuration: isTree ? (configuration as AvatarFile) : null,
      },
    ];
  } catch {
    return [nothing];
  }
}
