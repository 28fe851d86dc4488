/** The docs inside the console: a list of pages, a search over their headings, one page. */

import { parts } from "virtual:help";
import { Button, Text, TextInput } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, type KeyboardEvent, useEffect, useRef, useState } from "react";
import { Link } from "wouter";
import { isBusy } from "../cockpit/session/keys";
import { useTexts } from "../i18n";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { helpAddress } from "./address";
import classes from "./Help.module.css";
import { HelpBody, headingId } from "./HelpBody";
import type { HelpNode, HelpPage as Page } from "./nodes";
import { search } from "./search";

const PAGES: readonly Page[] = parts.flatMap(({ pages }) => pages);

interface HelpPageProps {
  readonly name: string | undefined;
  readonly heading: string | undefined;
}

export function HelpPage({ name, heading }: HelpPageProps): JSX.Element {
  const { t } = useTexts();
  const page = name === undefined ? PAGES[0] : PAGES.find(({ key }) => key === name);
  useTitle(page === undefined ? t("helpPages.title") : `${page.title} · ${t("helpPages.title")}`);
  return (
    <div className={classes.page}>
      <Contents current={page} />
      {page === undefined ? (
        <EmptyState
          icon="help"
          title={t("helpPages.unknown")}
          action={
            <Button component={Link} href="/help" variant="default">
              {t("helpPages.unknown.back")}
            </Button>
          }
        >
          {t("helpPages.unknown.body")}
        </EmptyState>
      ) : (
        <Article key={page.key} page={page} heading={heading} />
      )}
    </div>
  );
}

function Article({
  page,
  heading,
}: {
  readonly page: Page;
  readonly heading: string | undefined;
}): JSX.Element {
  const { t, language } = useTexts();
  const body = useQuery({
    queryKey: ["help", page.key],
    queryFn: async () => (await page.load()).body,
    staleTime: Number.POSITIVE_INFINITY,
  });
  return (
    <div className={classes.article}>
      {language !== "en" && <Text c="dimmed">{t("helpPages.language")}</Text>}
      <Loaded query={body}>{(nodes) => <Body nodes={nodes} heading={heading} />}</Loaded>
    </div>
  );
}

function Body({
  nodes,
  heading,
}: {
  readonly nodes: readonly HelpNode[];
  readonly heading: string | undefined;
}): JSX.Element {
  useEffect(() => {
    const target = heading === undefined ? null : document.getElementById(headingId(heading));
    if (target === null) window.scrollTo({ top: 0 });
    else {
      target.scrollIntoView();
      target.focus({ preventScroll: true });
    }
  }, [heading]);
  return (
    <article lang="en" className={classes.text}>
      <HelpBody body={nodes} />
    </article>
  );
}

/** The search and the list of pages. Arrow keys move through the list, as in a menu. */
function Contents({ current }: { readonly current: Page | undefined }): JSX.Element {
  const { t } = useTexts();
  const [query, setQuery] = useState("");
  const box = useRef<HTMLElement>(null);
  const input = useRef<HTMLInputElement>(null);
  useSearchKey(() => input.current?.focus());
  const found = search(parts, query);
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === "Escape") {
      setQuery("");
      input.current?.focus();
      return;
    }
    const direction = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (direction === undefined) return;
    const stops = [...(box.current?.querySelectorAll<HTMLElement>("input, a") ?? [])];
    const at = stops.indexOf(document.activeElement as HTMLElement);
    stops[Math.max(0, Math.min(stops.length - 1, at + direction))]?.focus();
    event.preventDefault();
  };
  return (
    <nav
      className={classes.contents}
      aria-label={t("helpPages.list")}
      ref={box}
      onKeyDown={onKeyDown}
    >
      <TextInput
        ref={input}
        type="search"
        aria-label={t("helpPages.search")}
        placeholder={t("helpPages.search")}
        leftSection={<Icon name="search" size={16} />}
        value={query}
        onChange={(event) => setQuery(event.currentTarget.value)}
      />
      <p className={classes.hint} role="status">
        {query.trim() === ""
          ? t("helpPages.keys")
          : found.length === 0
            ? t("helpPages.none")
            : t("helpPages.found", { count: found.length })}
      </p>
      <div lang="en">
        {query.trim() === "" ? (
          parts.map((part) => (
            <section key={part.title}>
              <h2 className={classes.part}>{part.title}</h2>
              <ul className={classes.list}>
                {part.pages.map((page) => (
                  <li key={page.key}>
                    <PageLink page={page} current={page === current} />
                  </li>
                ))}
              </ul>
            </section>
          ))
        ) : (
          <ul className={classes.list}>
            {found.map(({ page, heading }) => (
              <li key={`${page.key} ${heading?.id ?? ""}`}>
                <Link href={helpAddress(page.key, heading?.id)} className={classes.found ?? ""}>
                  {heading?.title ?? page.title}
                  <span>{heading === undefined ? page.about : page.title}</span>
                </Link>
              </li>
            ))}
          </ul>
        )}
      </div>
    </nav>
  );
}

/** A link to a page; below the current page its sections are listed. */
function PageLink({
  page,
  current,
}: {
  readonly page: Page;
  readonly current: boolean;
}): JSX.Element {
  const sections = page.headings.filter(({ level }) => level === 2);
  return (
    <>
      <Link
        href={helpAddress(page.key)}
        aria-current={current ? "page" : undefined}
        title={page.about}
      >
        {page.title}
      </Link>
      {current && sections.length > 0 && (
        <ul className={classes.sections}>
          {sections.map(({ id, title }) => (
            <li key={id}>
              <Link href={helpAddress(page.key, id)}>{title}</Link>
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

function useSearchKey(onSearch: () => void): void {
  useEffect(() => {
    const onKey = (event: globalThis.KeyboardEvent) => {
      if (event.key !== "/" || isBusy(event)) return;
      event.preventDefault();
      onSearch();
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  });
}
