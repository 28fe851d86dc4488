/** How a version came about, in words: also that it is a copy in which nothing was changed. */
import type { AvatarSummary } from "../bodies/queries";
import type { useTexts } from "../i18n";
import type { AvatarVersion } from "./api";

type Listed = Pick<AvatarSummary, "key" | "title" | "content_hashes" | "newest">;

/** The avatar whose version a first version repeats to the last value; null for none. */
export function copiedFrom(
  version: Pick<AvatarVersion, "number" | "content_hash" | "origin">,
  avatarKey: string,
  all: readonly Listed[],
): Listed | null {
  if (version.number !== 1 || version.origin === "shipped") return null;
  const others = all.filter(
    ({ key, content_hashes }) => key !== avatarKey && content_hashes.includes(version.content_hash),
  );
  // Of several with the same content, the one that is not a copy itself.
  return (
    others.find(({ content_hashes }) => content_hashes[0] !== version.content_hash) ??
    others.find(({ newest }) => newest.origin === "shipped") ??
    others[0] ??
    null
  );
}

export function originOf(
  version: AvatarVersion,
  avatarKey: string,
  all: readonly Listed[],
  t: ReturnType<typeof useTexts>["t"],
): string {
  const source = copiedFrom(version, avatarKey, all);
  return source === null
    ? t(`avatars.origin.${version.origin}`)
    : t("avatars.origin.copied", { title: source.title });
}
