/** The one navigation: Run, Results, Design and Lab, with the current page marked. */
import { ActionIcon, Menu, Tooltip } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import { useQuery } from "@tanstack/react-query";
import { type JSX, type ReactNode, useEffect, useRef } from "react";
import { Link, useLocation } from "wouter";
import { DownloadsButton } from "../downloads/DownloadsButton";
import { useTexts } from "../i18n";
import { AccountMenu } from "../pages/account/AccountMenu";
import { may } from "../permissions";
import { studiesQuery } from "../queries";
import { HelpMenu } from "../tour/HelpMenu";
import { Key } from "../ui/Key";
import { type CurrentStudy, useCurrentStudy } from "./currentStudy";
import classes from "./Frame.module.css";
import {
  GROUPS,
  type Group,
  isAllowed,
  isAt,
  LAB_PAGES,
  type Place as PlaceInfo,
  SECTIONS,
  sectionAt,
  studyIn,
} from "./places";

interface SidebarProps {
  readonly account: Account;
  /** Whether the names stand beside the icons. */
  readonly named: boolean;
  readonly onSearch: () => void;
  /** Missing in the drawer of a narrow window, which always has names. */
  readonly onToggle?: () => void;
}

export function Sidebar({ account, named, onSearch, onToggle }: SidebarProps): JSX.Element {
  const { t } = useTexts();
  const [address] = useLocation();
  const study = useCurrentStudy(address);
  const places = useRef<HTMLDivElement>(null);
  // In a low window the current page's place may be out of sight.
  // biome-ignore lint/correctness/useExhaustiveDependencies: looks again whenever the address changes
  useEffect(() => {
    places.current?.querySelector("[aria-current=page]")?.scrollIntoView({ block: "nearest" });
  }, [address, named]);
  return (
    <nav className={classes.sidebar} aria-label={t("frame.label")}>
      <div className={classes.head}>
        <Link
          href="/"
          className={classes.brand ?? ""}
          aria-label={named ? undefined : t("app.name")}
        >
          <Mark size={24} />
          {named && t("app.name")}
        </Link>
        {onToggle !== undefined && named && <Toggle named onToggle={onToggle} />}
      </div>
      <Labelled name={t("frame.search")} named={named}>
        <button
          type="button"
          className={classes.search}
          aria-label={named ? undefined : t("frame.search.long")}
          aria-keyshortcuts="Control+K Meta+K"
          onClick={onSearch}
        >
          <Icon name="search" size={17} />
          {named && (
            <>
              <span>{t("frame.search")}</span>
              <Key name="Ctrl K" />
            </>
          )}
        </button>
      </Labelled>
      <div ref={places} className={classes.places}>
        <Place href="/" icon="home" name={t("app.studies")} here={address === "/"} named={named} />
        <StudyChoice study={study} named={named} />
        {GROUPS.map((group) => (
          <PlaceGroup key={group} group={group} account={account} study={study} named={named} />
        ))}
      </div>
      <div className={classes.foot}>
        {may(account.role, "compare") && <DownloadsButton />}
        <HelpMenu />
        <AccountMenu account={account} named={named} />
        {onToggle !== undefined && !named && <Toggle named={false} onToggle={onToggle} />}
      </div>
    </nav>
  );
}

function Toggle({
  named,
  onToggle,
}: {
  readonly named: boolean;
  readonly onToggle: () => void;
}): JSX.Element {
  const { t } = useTexts();
  const name = t(named ? "frame.collapse" : "frame.expand");
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      aria-label={name}
      aria-expanded={named}
      title={name}
      onClick={onToggle}
    >
      <Icon name={named ? "back" : "forward"} size={17} />
    </ActionIcon>
  );
}

interface PlaceGroupProps {
  readonly group: Group;
  readonly account: Account;
  readonly study: CurrentStudy | null;
  readonly named: boolean;
}

function PlaceGroup({ group, account, study, named }: PlaceGroupProps): JSX.Element | null {
  const { t } = useTexts();
  const [address] = useLocation();
  const isShown = (place: PlaceInfo): boolean =>
    place.group === group && isAllowed(place, account.role);
  const sections = SECTIONS.filter(isShown);
  const pages = LAB_PAGES.filter(isShown);
  if (sections.length + pages.length === 0) return null;
  const here = studyIn(address) === study?.key ? sectionAt(address) : null;
  return (
    <section aria-labelledby={named ? `frame-${group}` : undefined} className={classes.group}>
      {named ? (
        <h2 id={`frame-${group}`} className={classes.title}>
          {t(`frame.${group}`)}
        </h2>
      ) : (
        <hr className={classes.rule} />
      )}
      <ul>
        {sections.map(({ section, icon, name }) => (
          <li key={section}>
            <Place
              // The places are kept while the studies are on their way, so that nothing moves.
              href={study === null ? "/" : `/studies/${encodeURIComponent(study.key)}/${section}`}
              icon={icon}
              name={t(name)}
              here={section === here}
              named={named}
            />
          </li>
        ))}
        {pages.map(({ href, icon, name }) => (
          <li key={href}>
            <Place
              href={href}
              icon={icon}
              name={t(name)}
              here={isAt(address, href)}
              named={named}
            />
          </li>
        ))}
      </ul>
    </section>
  );
}

interface PlaceProps {
  readonly href: string;
  readonly icon: Parameters<typeof Icon>[0]["name"];
  readonly name: string;
  readonly here: boolean;
  readonly named: boolean;
}

function Place({ href, icon, name, here, named }: PlaceProps): JSX.Element {
  return (
    <Labelled name={name} named={named}>
      <Link
        href={href}
        className={classes.place ?? ""}
        aria-current={here ? "page" : undefined}
        aria-label={named ? undefined : name}
      >
        <Icon name={icon} size={17} />
        {named && name}
      </Link>
    </Labelled>
  );
}

/** What has no name beside its icon shows it when it is pointed at or has the focus. */
function Labelled({
  name,
  named,
  children,
}: {
  readonly name: string;
  readonly named: boolean;
  readonly children: ReactNode;
}): JSX.Element {
  return (
    <Tooltip
      label={name}
      disabled={named}
      position="right"
      events={{ hover: true, focus: true, touch: false }}
    >
      {children}
    </Tooltip>
  );
}

/** Which study the sections belong to; another one opens on the same section. */
function StudyChoice({
  study,
  named,
}: {
  readonly study: CurrentStudy | null;
  readonly named: boolean;
}): JSX.Element {
  const { t, language } = useTexts();
  const [address, navigate] = useLocation();
  const query = useQuery(studiesQuery);
  const listed = query.data ?? [];
  const none = t(query.isPending ? "frame.study.loading" : "frame.study.none");
  const label = study?.title ?? study?.key ?? none;
  const section = sectionAt(address) ?? "overview";
  return (
    <Menu position="right-start" width={280} withInitialFocusPlaceholder={false}>
      <Menu.Target>
        <button
          type="button"
          className={classes.study}
          aria-label={`${t("frame.study.choose")}: ${label}`}
          title={label}
          disabled={listed.length === 0}
        >
          {named ? (
            <>
              <span className={classes.studyName}>{label}</span>
              <Icon name="down" size={14} />
            </>
          ) : (
            <Icon name="document" size={17} />
          )}
        </button>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Label>{t("frame.study.choose")}</Menu.Label>
        {listed.map(({ key, titles }) => (
          <Menu.Item
            key={key}
            aria-current={key === study?.key ? "true" : undefined}
            rightSection={key === study?.key ? <Icon name="check" size={15} /> : null}
            onClick={() => navigate(`/studies/${encodeURIComponent(key)}/${section}`)}
          >
            {inLanguage(titles, language)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
