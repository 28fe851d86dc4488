/** Search over pages, studies, participants with their sessions, settings and help: Ctrl+K. */
import { parts } from "virtual:help";
import {
  Combobox,
  Modal,
  TextInput,
  useCombobox,
  useComputedColorScheme,
  useMantineColorScheme,
} from "@mantine/core";
import type { Account } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { useQueries, useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { useLocation } from "wouter";
import { helpAddress } from "../help/address";
import { search } from "../help/search";
import { useTexts } from "../i18n";
import { may } from "../permissions";
import { sessionsQuery, studiesQuery } from "../queries";
import { useCurrentStudy } from "./currentStudy";
import { type Entry, found, KINDS } from "./entries";
import classes from "./Frame.module.css";
import { isAllowed, LAB_PAGES, SECTIONS } from "./places";

interface PaletteProps {
  readonly account: Account;
  readonly address: string;
  readonly onClose: () => void;
}

export function Palette({ account, address, onClose }: PaletteProps): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const [query, setQuery] = useState("");
  // Its list is always open: the dialog is what opens and closes.
  const combobox = useCombobox({ opened: true });
  const entries = useEntries(account, address);
  const shown = [...found(entries, query), ...useHelpEntries(query)];
  // The first result is chosen, so that Enter alone opens it.
  // biome-ignore lint/correctness/useExhaustiveDependencies: whenever the results change
  useEffect(() => {
    combobox.selectFirstOption();
  }, [query, shown.length]);
  const choose = (id: string): void => {
    const entry = shown.find((one) => one.id === id);
    if (entry === undefined) return;
    onClose();
    if (typeof entry.go === "string") navigate(entry.go);
    else entry.go();
  };
  return (
    <Modal
      opened
      onClose={onClose}
      withCloseButton={false}
      centered={false}
      yOffset="12vh"
      size={620}
      title={t("frame.search.long")}
    >
      <Combobox store={combobox} onOptionSubmit={choose}>
        <Combobox.EventsTarget withExpandedAttribute>
          <TextInput
            data-autofocus
            role="combobox"
            size="md"
            leftSection={<Icon name="search" size={18} />}
            aria-label={t("frame.search.long")}
            placeholder={t("frame.search.placeholder")}
            value={query}
            onChange={(event) => setQuery(event.currentTarget.value)}
          />
        </Combobox.EventsTarget>
        <Combobox.Options className={classes.results ?? ""}>
          {KINDS.map((kind) => {
            const own = shown.filter((entry) => entry.kind === kind);
            if (own.length === 0) return null;
            return (
              <Combobox.Group key={kind} label={t(`frame.search.${kind}`)}>
                {own.map(({ id, icon, title, about }) => (
                  <Combobox.Option key={id} value={id}>
                    <span className={classes.result}>
                      <Icon name={icon} size={16} />
                      {title}
                      <small>{about}</small>
                    </span>
                  </Combobox.Option>
                ))}
              </Combobox.Group>
            );
          })}
        </Combobox.Options>
      </Combobox>
      <p className={shown.length === 0 ? classes.nothing : classes.keys} role="status">
        {t(shown.length === 0 ? "frame.search.nothing" : "frame.search.keys")}
      </p>
    </Modal>
  );
}

/** Everything but the help, as this account may see it. */
function useEntries(account: Account, address: string): readonly Entry[] {
  const { t, language, setLanguage } = useTexts();
  const { setColorScheme } = useMantineColorScheme();
  const scheme = useComputedColorScheme("light");
  const study = useCurrentStudy(address);
  const listed = useQuery(studiesQuery).data ?? [];
  const sessions = useQueries({ queries: listed.map(({ key }) => sessionsQuery(key)) });
  const pages: readonly Entry[] = [
    {
      kind: "pages",
      id: "/",
      icon: "home",
      title: t("app.studies"),
      about: "",
      go: "/",
    },
    ...SECTIONS.filter((section) => study !== null && isAllowed(section, account.role)).map(
      ({ section, icon, name, group }): Entry => ({
        kind: "pages",
        id: `section ${section}`,
        icon,
        title: t(name),
        about: `${t(`frame.${group}`)} · ${study?.title ?? study?.key}`,
        go: `/studies/${encodeURIComponent(study?.key ?? "")}/${section}`,
      }),
    ),
    ...LAB_PAGES.filter((page) => isAllowed(page, account.role)).map(
      ({ href, icon, name, group }): Entry => ({
        kind: "pages",
        id: href,
        icon,
        title: t(name),
        about: t(`frame.${group}`),
        go: href,
      }),
    ),
  ];
  const studies = listed.map(
    ({ key, titles }): Entry => ({
      kind: "studies",
      id: `study ${key}`,
      icon: "document",
      title: inLanguage(titles, language),
      about: key,
      go: `/studies/${encodeURIComponent(key)}`,
    }),
  );
  const visits = sessions.flatMap(({ data }, at) =>
    (data ?? []).map(
      (session): Entry => ({
        kind: "sessions",
        id: session.id,
        icon: "people",
        title: session.participant_code,
        about: `${t(`status.${session.status}`)} · ${inLanguage(listed[at]?.titles, language)}`,
        go: `/sessions/${session.id}`,
      }),
    ),
  );
  const other = scheme === "light" ? "dark" : "light";
  const settings: readonly Entry[] = [
    {
      kind: "settings",
      id: "appearance",
      icon: other === "dark" ? "moon" : "sun",
      title: t(`app.theme.${other}`),
      about: "",
      go: () => setColorScheme(other),
    },
    {
      kind: "settings",
      id: "language",
      icon: "talk",
      title: t("frame.search.language"),
      about: "",
      go: () => setLanguage(language === "en" ? "de" : "en"),
    },
    ...(may(account.role, "design")
      ? [
          {
            kind: "settings",
            id: "new study",
            icon: "add",
            title: t("new.title"),
            about: "",
            go: "/new",
          } as const,
        ]
      : []),
  ];
  return [...pages, ...studies, ...visits, ...settings];
}

function useHelpEntries(query: string): readonly Entry[] {
  return search(parts, query)
    .slice(0, 8)
    .map(({ page, heading }) => ({
      kind: "help",
      id: `help ${page.key} ${heading?.id ?? ""}`,
      icon: "help",
      title: heading?.title ?? page.title,
      about: heading === undefined ? page.about : page.title,
      go: helpAddress(page.key, heading?.id),
    }));
}
