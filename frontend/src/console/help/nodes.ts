/** What `frontend/helpPages.ts` makes of the docs, and the console's help draws. */

/** A piece of a page: text, or an element with its attributes and what is inside. */
export type HelpNode =
  | string
  | readonly [tag: string, attributes: Readonly<Record<string, string>>, ...inside: HelpNode[]];

export interface HelpHeading {
  /** As in links to the same file on GitHub. */
  readonly id: string;
  /** 2 for a section of the page, and so on. */
  readonly level: number;
  readonly title: string;
}

export interface HelpPage {
  /** In addresses: the name of its file. */
  readonly key: string;
  readonly title: string;
  /** The sentence that `docs/README.md` has about it. */
  readonly about: string;
  readonly headings: readonly HelpHeading[];
  readonly load: () => Promise<{ readonly body: readonly HelpNode[] }>;
}

export interface HelpPart {
  readonly title: string;
  readonly pages: readonly HelpPage[];
}
