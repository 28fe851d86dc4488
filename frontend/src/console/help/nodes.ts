/**
 * The types shared by `frontend/helpPages.ts`, which converts the docs, and the help, which renders
 * them.
 */

/** A node of a page: text, or an element with its attributes and children. */
export type HelpNode =
  | string
  | readonly [tag: string, attributes: Readonly<Record<string, string>>, ...inside: HelpNode[]];

export interface HelpHeading {
  /** As in links to the same file on GitHub. */
  readonly id: string;
  /** 2 for a section of the page, 3 for a subsection, and so on. */
  readonly level: number;
  readonly title: string;
}

export interface HelpPage {
  /** The key in addresses: the name of its file. */
  readonly key: string;
  readonly title: string;
  /** The sentence about it in `docs/README.md`. */
  readonly about: string;
  readonly headings: readonly HelpHeading[];
  readonly load: () => Promise<{ readonly body: readonly HelpNode[] }>;
}

export interface HelpPart {
  readonly title: string;
  readonly pages: readonly HelpPage[];
}
