/**
 * Make the console's help pages from the Markdown files in `docs/`.
 *
 * `docs/README.md` is the table of contents: the help takes its parts and sentences from there,
 * without the pages in NOT_SHOWN. The module `virtual:help` contains titles and headings, for the
 * list and the search; the body of each page is a module of its own, fetched when the page is
 * opened.
 * Bodies are trees of elements rather than HTML, so the console can draw them without trusting a
 * string. Markdown that cannot be converted to such a tree fails the build.
 */
import { existsSync, readFileSync } from "node:fs";
import { basename, dirname, resolve } from "node:path";
import { marked, type Token, type Tokens } from "marked";
import type { Plugin } from "vite";
import type { HelpHeading, HelpNode } from "./src/console/help/nodes.ts";

/** Pages for those who operate the server or change the code, and long lists of figures. */
const NOT_SHOWN: ReadonlySet<string> = new Set([
  "docs/architecture.md",
  "docs/benchmarks.md",
  "docs/claims.md",
  "docs/decisions/README.md",
  "docs/faults.md",
  "docs/pages.md",
  "docs/statistics-error-rates.md",
  "docs/telemetry-encoding.md",
  "docs/walking-replication.md",
  "CONTRIBUTING.md",
]);
const MODULE = "virtual:help";
const MAP = "docs/README.md";

interface Listed {
  readonly key: string;
  /** The title in the table of contents, which is shorter than the page's own. */
  readonly title: string;
  readonly file: string;
  readonly about: string;
}

interface ListedPart {
  readonly title: string;
  readonly pages: readonly Listed[];
}

interface ParsedPage {
  readonly headings: readonly HelpHeading[];
  readonly body: readonly HelpNode[];
  /** The pictures of the page; its body refers to them by their index in this list. */
  readonly pictures: readonly string[];
}

export function helpPages(repository: string): Plugin {
  const docs = loadDocs(repository);
  return {
    name: "help-pages",
    resolveId: (id) => (id === MODULE || id.startsWith(`${MODULE}/`) ? `\0${id}` : undefined),
    load(id) {
      if (id === `\0${MODULE}`) {
        this.addWatchFile(resolve(repository, MAP));
        return docs.contents();
      }
      if (!id.startsWith(`\0${MODULE}/`)) return undefined;
      const key = id.slice(MODULE.length + 2);
      const file = docs.fileOf(key);
      if (file !== undefined) this.addWatchFile(resolve(repository, file));
      return docs.body(key);
    },
  };
}

interface Docs {
  /** The file of a page, or undefined if no page has this key. */
  readonly fileOf: (key: string) => string | undefined;
  /** The source of `virtual:help`. */
  readonly contents: () => string;
  /** The source of `virtual:help/KEY`, or undefined if no page has this key. */
  readonly body: (key: string) => string | undefined;
}

/** Convert the docs of a repository to modules; the files are read again at each call. */
export function loadDocs(repository: string): Docs {
  const read = (file: string) => readFileSync(resolve(repository, file), "utf8");
  const parts = () => listedParts(read(MAP));
  const keys = () => keysOf(parts());
  const make = (file: string) =>
    pageFrom(read(file), (target) => resolveLink(repository, keys(), file, target));
  const fileOf = (key: string) => [...keys()].find(([, other]) => other === key)?.[0];
  return {
    fileOf,
    contents: () => contentsModule(parts(), make),
    body(key) {
      const file = fileOf(key);
      return file === undefined ? undefined : bodyModule(make(file));
    },
  };
}

/** The parts of the table of contents, with the pages that the console shows. */
export function listedParts(map: string): readonly ListedPart[] {
  const parts: { title: string; pages: Listed[] }[] = [];
  for (const line of map.split("\n")) {
    const [, title] = /^## (.+)$/.exec(line) ?? [];
    if (title !== undefined) parts.push({ title, pages: [] });
    const [, name, target, about] = /^- \[([^\]]+)\]\(([^)]+\.md)\): (.+)$/.exec(line) ?? [];
    if (name === undefined || target === undefined || about === undefined) continue;
    const file = inRepository(MAP, target);
    if (!NOT_SHOWN.has(file))
      parts.at(-1)?.pages.push({ key: keyOf(file), title: name, file, about });
  }
  return parts;
}

/** The key of a page: `backups` for docs/backups.md; a README gets the name of its folder. */
const keyOf = (file: string): string =>
  basename(file) === "README.md"
    ? basename(dirname(file)).replaceAll("_", "-")
    : basename(file, ".md");

const keysOf = (parts: readonly ListedPart[]): ReadonlyMap<string, string> =>
  new Map(parts.flatMap(({ pages }) => pages.map(({ file, key }) => [file, key] as const)));

/** Resolve a link `target` found in `file` to a path in the repository. */
const inRepository = (file: string, target: string): string =>
  resolve("/", dirname(file), target).slice(1);

type Followed = Readonly<Record<string, string>> | "elsewhere";

/** Where a link or picture leads: to a help page, the web, a file to be shown, or elsewhere. */
function resolveLink(
  repository: string,
  keys: ReadonlyMap<string, string>,
  file: string,
  target: string,
): Followed {
  if (/^https?:/.test(target)) return { href: target };
  const [path = "", anchor] = target.split("#");
  const to = path === "" ? file : inRepository(file, path);
  const key = keys.get(to);
  if (key !== undefined) return { to: `/help/${key}${anchor === undefined ? "" : `/${anchor}`}` };
  if (!existsSync(resolve(repository, to))) throw new Error(`${file} links to ${to}: no such file`);
  return to.endsWith(".png") ? { picture: resolve(repository, to) } : "elsewhere";
}

function contentsModule(parts: readonly ListedPart[], make: (file: string) => ParsedPage): string {
  const written = parts
    .filter(({ pages }) => pages.length > 0)
    .map(({ title, pages }) => {
      const shown = pages.map(({ key, title: name, file, about }) => {
        const entry = { key, title: name, about: plain(about), headings: make(file).headings };
        const load = `() => import(${JSON.stringify(`${MODULE}/${key}`)})`;
        return `{ ...${JSON.stringify(entry)}, load: ${load} }`;
      });
      return `{ title: ${JSON.stringify(title)}, pages: [${shown.join(",\n")}] }`;
    });
  return `export const parts = [${written.join(",\n")}];`;
}

function bodyModule({ body, pictures }: ParsedPage): string {
  const imports = pictures.map((path, at) => `import p${at} from ${JSON.stringify(path)};`);
  const tree = JSON.stringify(body).replaceAll(/"picture:(\d+)"/g, "p$1");
  return [...imports, `export const body = ${tree};`].join("\n");
}

/** Convert a Markdown text to a page; `follow` resolves its links. */
export function pageFrom(text: string, follow: (target: string) => Followed): ParsedPage {
  const headings: HelpHeading[] = [];
  const pictures: string[] = [];
  const seen = new Map<string, number>();

  const inside = (tokens: readonly Token[] | undefined): HelpNode[] => (tokens ?? []).flatMap(node);
  const idOf = (heading: string): string => {
    const slug = slugOf(heading);
    const times = seen.get(slug) ?? 0;
    seen.set(slug, times + 1);
    return times === 0 ? slug : `${slug}-${times}`;
  };
  const heading = (token: Tokens.Heading): HelpNode[] => {
    const words = textOf(inside(token.tokens));
    const id = idOf(words);
    if (token.depth > 1) headings.push({ id, level: token.depth, title: words });
    return [[`h${token.depth}`, { id }, ...inside(token.tokens)]];
  };
  const link = (token: Tokens.Link): HelpNode[] => {
    const to = follow(token.href);
    return to === "elsewhere" ? inside(token.tokens) : [["a", to, ...inside(token.tokens)]];
  };
  const image = (token: Tokens.Image): HelpNode[] => {
    const to = follow(token.href);
    if (to === "elsewhere" || to.picture === undefined)
      throw new Error(`${token.href} is no picture of the repository`);
    pictures.push(to.picture);
    return [["img", { src: `picture:${pictures.length - 1}`, alt: token.text }]];
  };
  const cell = (tag: string, found: Tokens.TableCell): HelpNode => [
    tag,
    {},
    ...inside(found.tokens),
  ];
  const table = (token: Tokens.Table): HelpNode[] => [
    [
      "table",
      {},
      ["thead", {}, ["tr", {}, ...token.header.map((found) => cell("th", found))]],
      [
        "tbody",
        {},
        ...token.rows.map((row): HelpNode => ["tr", {}, ...row.map((found) => cell("td", found))]),
      ],
    ],
  ];
  const list = (token: Tokens.List): HelpNode[] => [
    [
      token.ordered ? "ol" : "ul",
      {},
      ...token.items.map((item): HelpNode => ["li", {}, ...inside(item.tokens)]),
    ],
  ];
  const node = (token: Token): HelpNode[] => {
    switch (token.type) {
      case "space":
      case "def":
        return [];
      case "heading":
        return heading(token as Tokens.Heading);
      case "paragraph":
        return [["p", {}, ...inside((token as Tokens.Paragraph).tokens)]];
      case "text": {
        const found = token as Tokens.Text;
        return found.tokens === undefined ? [unescaped(found.text)] : inside(found.tokens);
      }
      case "escape":
        return [(token as Tokens.Escape).text];
      case "codespan":
        return [["code", {}, (token as Tokens.Codespan).text]];
      case "code":
        return [["pre", {}, ["code", {}, (token as Tokens.Code).text]]];
      case "strong":
      case "em":
        return [[token.type, {}, ...inside((token as Tokens.Strong).tokens)]];
      case "br":
      case "hr":
        return [[token.type, {}]];
      case "link":
        return link(token as Tokens.Link);
      case "image":
        return image(token as Tokens.Image);
      case "list":
        return list(token as Tokens.List);
      case "table":
        return table(token as Tokens.Table);
      default:
        throw new Error(`The help has no way to show Markdown of type ${token.type}: ${token.raw}`);
    }
  };
  const body = inside(marked.lexer(text));
  return { headings, body, pictures };
}

/** The anchor that GitHub gives to a heading. */
export const slugOf = (heading: string): string =>
  heading
    .toLowerCase()
    .replaceAll(/[^\p{L}\p{N}_\- ]/gu, "")
    .replaceAll(" ", "-");

const textOf = (nodes: readonly HelpNode[]): string =>
  nodes
    .map((node) => (typeof node === "string" ? node : textOf(node.slice(2) as HelpNode[])))
    .join("");

/** A sentence without its Markdown markup. */
const plain = (text: string): string =>
  text.replaceAll(/\[([^\]]*)\]\([^)]*\)/g, "$1").replaceAll(/[`*]/g, "");

const ENTITIES: Readonly<Record<string, string>> = {
  "&amp;": "&",
  "&lt;": "<",
  "&gt;": ">",
  "&quot;": '"',
  "&#39;": "'",
};

const unescaped = (text: string): string =>
  text.replaceAll(/&(?:amp|lt|gt|quot|#39);/g, (entity) => ENTITIES[entity] ?? entity);
