/** Render the tree of a help page. */
import { createElement, type JSX, type ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import classes from "./Help.module.css";
import type { HelpNode } from "./nodes";

/** Headings get a prefix so that their ids are unique on the page. */
export const headingId = (id: string): string => `help-${id}`;

export function HelpBody({ body }: { readonly body: readonly HelpNode[] }): JSX.Element {
  const { t } = useTexts();
  const drawn = (nodes: readonly HelpNode[]): ReactNode[] =>
    nodes.map((node, at) => {
      if (typeof node === "string") return node;
      const [tag, attributes, ...inside] = node;
      // A page never changes while it is shown, so positions can serve as keys.
      return element(String(at), tag, attributes, drawn(inside), t("helpPages.table"));
    });
  return <>{drawn(body)}</>;
}

function element(
  key: string,
  tag: string,
  attributes: Readonly<Record<string, string>>,
  inside: ReactNode[],
  table: string,
): ReactNode {
  const { id, to, href, src, alt } = attributes;
  if (id !== undefined) return createElement(tag, { key, id: headingId(id), tabIndex: -1 }, inside);
  if (to !== undefined)
    return (
      <Link key={key} href={to}>
        {inside}
      </Link>
    );
  if (href !== undefined)
    return (
      <a key={key} href={href} target="_blank" rel="noreferrer">
        {inside}
      </a>
    );
  if (tag === "img") return <img key={key} src={src} alt={alt} loading="lazy" />;
  if (tag === "table")
    return (
      // A figure, not a region: a page has several tables, and regions need names of their own.
      // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
      <figure key={key} className={classes.table} aria-label={table} tabIndex={0}>
        <table>{inside}</table>
      </figure>
    );
  if (tag === "pre")
    return (
      // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
      <pre key={key} tabIndex={0}>
        {inside}
      </pre>
    );
  return inside.length === 0 ? createElement(tag, { key }) : createElement(tag, { key }, inside);
}
