/** A text of the study, as pages that can be read in a headset: few words, and no scrolling. */
import { type Paragraph, paragraphs } from "@shared/text";
import type { PanelContent } from "./content";
import { fits } from "./surface/layout";
import type { PanelScreen } from "./surface/screen";
import type { Measure } from "./surface/wrap";
import type { PanelWords } from "./texts";

/** More words than this on one page are not read in a headset. */
export const MAX_WORDS = 60;

const wordsOf = (text: string): number => text.split(/\s+/).filter((word) => word !== "").length;

const wordsIn = (paragraph: Paragraph): number => {
  switch (paragraph.kind) {
    case "picture":
      return 0;
    case "points":
      return paragraph.points.reduce((sum, point) => sum + wordsOf(point), 0);
    default:
      return wordsOf(paragraph.text);
  }
};

/** Parts of a paragraph that each fit a page: points one by one, prose by its sentences. */
function parts(paragraph: Paragraph): readonly Paragraph[] {
  switch (paragraph.kind) {
    case "picture":
      // The scene itself shows what the tablet's pictures show: mirror, boxes, the pose.
      return [];
    case "heading":
      return [paragraph];
    case "points":
      return paragraph.points.flatMap((point) =>
        pieces(point).map((text) => ({ kind: "points", points: [text] }) as const),
      );
    case "prose":
      return pieces(paragraph.text).map((text) => ({ kind: "prose", text }) as const);
  }
}

/** A text as pieces of at most `MAX_WORDS` words: sentences, or parts of a very long one. */
function pieces(text: string): readonly string[] {
  const sentences = text.split(/(?<=[.!?…]["“”’']?)\s+(?=[\p{Lu}„“"‘])/u);
  return sentences.flatMap((sentence) => {
    const words = sentence.split(/\s+/);
    const count = Math.ceil(words.length / MAX_WORDS);
    const each = Math.ceil(words.length / count);
    return Array.from({ length: count }, (_, at) =>
      words.slice(at * each, (at + 1) * each).join(" "),
    );
  });
}

/** Put a part at the end of a page; what came from one paragraph becomes one again. */
function joined(page: readonly Paragraph[], part: Paragraph, continues: boolean): Paragraph[] {
  const last = page.at(-1);
  if (last?.kind === "points" && part.kind === "points") {
    return [...page.slice(0, -1), { kind: "points", points: [...last.points, ...part.points] }];
  }
  if (continues && last?.kind === "prose" && part.kind === "prose") {
    return [...page.slice(0, -1), { kind: "prose", text: `${last.text} ${part.text}` }];
  }
  return [...page, part];
}

/** Divide a text into pages that have at most 60 words and fit the panel. */
export function pagesOfText(
  text: string,
  holds: (page: readonly Paragraph[]) => boolean,
): readonly (readonly Paragraph[])[] {
  const pages: Paragraph[][] = [];
  let page: Paragraph[] = [];
  for (const paragraph of paragraphs(text)) {
    for (const [at, part] of parts(paragraph).entries()) {
      const longer = joined(page, part, at > 0);
      const words = longer.reduce((sum, one) => sum + wordsIn(one), 0);
      const stays = words <= MAX_WORDS && holds(longer);
      if (page.length === 0 || stays) {
        page = longer;
        continue;
      }
      // A heading belongs to what follows it.
      const heading = page.at(-1)?.kind === "heading" && page.length > 1 ? page.pop() : undefined;
      pages.push(page);
      page = heading === undefined ? [part] : [heading, part];
    }
  }
  if (page.length > 0) pages.push(page);
  return pages.length === 0 ? [[]] : pages;
}

export interface ReadingOptions {
  readonly title: string;
  readonly text: string;
  readonly words: PanelWords;
  readonly measure: Measure;
  /** Called when the last page was confirmed; null for a text that only waits to be read. */
  readonly onRead: (() => void) | null;
  /** Called when the participant has a question; null where nobody can be called. */
  readonly onAsk?: (() => void) | null;
  /** Whether it stands beside the view straight ahead, where the mirror is. */
  readonly isBeside?: boolean;
}

/** A text with "next" and "back", and on its last page the confirmation that it was read. */
export class Reading implements PanelContent {
  onChange: (() => void) | null = null;
  readonly #options: ReadingOptions;
  readonly #pages: readonly (readonly Paragraph[])[];
  #page = 0;
  #isAsking = false;

  constructor(options: ReadingOptions) {
    this.#options = options;
    this.#pages = pagesOfText(options.text, (page) =>
      fits(this.#screenOf(page, 1, 3), options.measure),
    );
  }

  get screen(): PanelScreen {
    const { words } = this.#options;
    if (this.#isAsking) {
      return {
        key: "reading asked",
        title: words("reading.asked.title"),
        body: [{ kind: "prose", text: words("reading.asked.body") }],
        buttons: [
          { target: "continue", text: words("reading.continue"), side: "right", isPrimary: true },
        ],
      };
    }
    return this.#screenOf(this.#pages[this.#page] ?? [], this.#page, this.#pages.length);
  }

  #screenOf(body: readonly Paragraph[], page: number, pages: number): PanelScreen {
    const { title, words, onRead, onAsk = null, isBeside = false } = this.#options;
    const isLast = page >= pages - 1;
    const ahead = isLast
      ? onRead === null
        ? []
        : [{ target: "done", text: words("reading.done"), side: "right", isPrimary: true } as const]
      : [{ target: "next", text: words("form.next"), side: "right", isPrimary: true } as const];
    const back =
      page === 0 ? [] : [{ target: "back", text: words("form.back"), side: "left" } as const];
    const ask =
      onAsk === null || (!isLast && page > 0)
        ? []
        : [{ target: "ask", text: words("reading.ask"), side: "left" } as const];
    const text = words("reading.page", { page: page + 1, pages });
    return {
      key: `reading ${title} ${page}`,
      isBeside,
      title,
      body,
      buttons: [...back, ...ask, ...ahead],
      ...(pages > 1 && ask.length === 0 ? { progress: { done: page + 1, of: pages, text } } : {}),
    };
  }

  press(target: string): void {
    switch (target) {
      case "next":
        this.#page = Math.min(this.#page + 1, this.#pages.length - 1);
        break;
      case "back":
        this.#page = Math.max(this.#page - 1, 0);
        break;
      case "ask":
        this.#isAsking = true;
        this.#options.onAsk?.();
        break;
      case "continue":
        this.#isAsking = false;
        break;
      case "done":
        this.#options.onRead?.();
        return;
    }
    this.onChange?.();
  }
}
