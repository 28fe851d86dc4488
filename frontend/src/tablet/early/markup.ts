/**
 * The HTML of a React element whose components use no hooks, as `renderToStaticMarkup` writes it.
 *
 * React's own is half as large as the tablet's whole script, and a participant would wait for it.
 * What it cannot draw is an error; a test compares both.
 */
import type { ReactElement, ReactNode } from "react";
// Not from React itself, which is not needed for it.
import { Fragment } from "react/jsx-runtime";

const NAMES: Readonly<Record<string, string>> = {
  className: "class",
  tabIndex: "tabindex",
  strokeLinecap: "stroke-linecap",
  strokeLinejoin: "stroke-linejoin",
  strokeWidth: "stroke-width",
};
/** Names that are the same in HTML, or in SVG. */
const PLAIN = /^(?:[a-z]+|inputMode|maxLength|viewBox|(?:aria|data)-[a-z]+)$/;
/** Not drawn: what only React acts on. */
const SKIPPED = /^(?:children|ref|key|on[A-Z]\w*)$/;
const SWITCHES = new Set(["checked", "disabled"]);
const EMPTY = new Set(["input", "br"]);
/** Elements whose attributes React does not write as they are. */
const OTHERS = new Set(["textarea", "select", "option"]);
const ESCAPES: Readonly<Record<string, string>> = {
  "&": "&amp;",
  "<": "&lt;",
  ">": "&gt;",
  '"': "&quot;",
  "'": "&#x27;",
};

const escaped = (text: string): string => text.replace(/[&<>"']/g, (one) => ESCAPES[one] ?? one);

export function markup(node: ReactNode): string {
  if (node === null || node === undefined || typeof node === "boolean") return "";
  if (typeof node === "string" || typeof node === "number") return escaped(String(node));
  if (Array.isArray(node)) return node.map(markup).join("");
  if (typeof node !== "object" || !isElement(node))
    throw new Error(`This cannot be drawn: ${String(node)}`);
  const { type, props } = node;
  if (type === Fragment) return markup(props.children);
  if (typeof type === "function") {
    return markup((type as (props: Props) => ReactNode)(props));
  }
  if (typeof type !== "string" || OTHERS.has(type)) {
    throw new Error(`The element ${String(type)} cannot be drawn.`);
  }
  const start = `<${type}${attributes(props)}>`;
  return EMPTY.has(type) ? start : `${start}${markup(props.children)}</${type}>`;
}

type Props = Readonly<Record<string, unknown>> & { readonly children?: ReactNode };

const isElement = (node: object): node is ReactElement<Props> => "type" in node && "props" in node;

function attributes(props: Props): string {
  return Object.entries(props)
    .filter(([name, value]) => value !== undefined && value !== null && !SKIPPED.test(name))
    .map(([name, value]) => attribute(name, value))
    .join("");
}

function attribute(name: string, value: unknown): string {
  if (SWITCHES.has(name)) return value === true ? ` ${name}=""` : "";
  const written = NAMES[name] ?? (PLAIN.test(name) ? name : null);
  if (written === null || typeof value === "object") {
    throw new Error(`The attribute ${name} cannot be drawn.`);
  }
  return ` ${written}="${escaped(String(value))}"`;
}
