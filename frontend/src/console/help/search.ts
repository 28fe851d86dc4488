/** Search the headings of the help by their words. */
import type { HelpHeading, HelpPage, HelpPart } from "./nodes";

export interface SearchMatch {
  readonly page: HelpPage;
  /** Undefined if the match is the page itself. */
  readonly heading: HelpHeading | undefined;
}

const MAX_RESULTS = 40;

/**
 * Find the pages and headings that contain every word of `query`, in any order and as parts of
 * words.
 *
 * A heading is searched together with its page's title, so "backup restore" finds "Restoring" on
 * the
 * page "Backups". Pages come before headings, and those that start with the query come first.
 */
export function search(parts: readonly HelpPart[], query: string): readonly SearchMatch[] {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return [];
  const has = (text: string) => words.every((word) => text.toLowerCase().includes(word));
  const own = (text: string) => words.some((word) => text.toLowerCase().includes(word));
  const found = parts.flatMap(({ pages }) =>
    pages.flatMap((page): readonly SearchMatch[] => [
      ...(has(`${page.title} ${page.about}`) ? [{ page, heading: undefined }] : []),
      ...page.headings
        .filter(({ title }) => own(title) && has(`${page.title} ${title}`))
        .map((heading) => ({ page, heading })),
    ]),
  );
  const rank = ({ page, heading }: SearchMatch): number => {
    const title = (heading?.title ?? page.title).toLowerCase();
    return (title.startsWith(words[0] ?? "") ? 0 : 2) + (heading === undefined ? 0 : 1);
  };
  return found.toSorted((a, b) => rank(a) - rank(b)).slice(0, MAX_RESULTS);
}
