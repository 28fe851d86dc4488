/**
 * The pages of the console in the order of the work: a study is run, its results are read, the next
 * one is designed, and the lab is looked after.
 *
 * The sidebar and the palette list these. A study's sections need a study: the one that is open, or
 * the one that was open last.
 */
import type { Role } from "@shared/api/people";
import type { IconName } from "@shared/ui/Icon";
import type { Key } from "../i18n";
import { may, type Permission } from "../permissions";

export const GROUPS = ["run", "results", "design", "lab"] as const;
export type Group = (typeof GROUPS)[number];

export interface Place {
  readonly group: Group;
  readonly icon: IconName;
  readonly name: Key;
  /** The permission required to see it; without one it is shown to everybody. */
  readonly permission?: Permission;
}

/** A page of every study, at `/studies/KEY/SECTION`. */
export interface Section extends Place {
  readonly section: string;
}

/** A page of the whole lab. */
export interface LabPage extends Place {
  readonly href: string;
}

export const SECTIONS = [
  { section: "overview", group: "run", icon: "info", name: "study.tab.overview" },
  { section: "sessions", group: "run", icon: "headset", name: "study.tab.sessions" },
  {
    section: "participants",
    group: "run",
    icon: "people",
    name: "study.tab.participants",
    permission: "rights",
  },
  { section: "ledger", group: "run", icon: "list", name: "study.tab.ledger" },
  {
    section: "summary",
    group: "results",
    icon: "flag",
    name: "study.tab.summary",
    permission: "compare",
  },
  {
    section: "dashboard",
    group: "results",
    icon: "chart",
    name: "study.tab.dashboard",
    permission: "compare",
  },
  {
    section: "statistics",
    group: "results",
    icon: "sigma",
    name: "study.tab.statistics",
    permission: "compare",
  },
  {
    section: "preregistration",
    group: "results",
    icon: "lock",
    name: "study.tab.preregistration",
    permission: "compare",
  },
  {
    section: "export",
    group: "results",
    icon: "download",
    name: "study.tab.export",
    permission: "compare",
  },
  {
    section: "protocol",
    group: "design",
    icon: "document",
    name: "study.tab.protocol",
    permission: "compare",
  },
  {
    section: "pilot",
    group: "design",
    icon: "flask",
    name: "study.tab.pilot",
    permission: "compare",
  },
  {
    section: "versions",
    group: "design",
    icon: "redo",
    name: "versions.tab",
    permission: "compare",
  },
  { section: "suggestions", group: "design", icon: "talk", name: "suggestions.tab" },
] as const satisfies readonly Section[];

export type SectionName = (typeof SECTIONS)[number]["section"];

export const LAB_PAGES: readonly LabPage[] = [
  { href: "/instruments", group: "design", icon: "form", name: "instruments.title" },
  { href: "/captures", group: "design", icon: "walk", name: "captures.title" },
  { href: "/bodies", group: "design", icon: "body", name: "bodies.title" },
  { href: "/avatars", group: "design", icon: "joint", name: "avatars.title" },
  { href: "/walking", group: "design", icon: "foot", name: "walking.title" },
  { href: "/equipment", group: "lab", icon: "tablet", name: "equipment.title" },
  { href: "/trackers", group: "lab", icon: "plug", name: "trackers.title" },
  { href: "/network", group: "lab", icon: "link", name: "network.title", permission: "network" },
  { href: "/storage", group: "lab", icon: "disk", name: "storage.title", permission: "storage" },
  { href: "/people", group: "lab", icon: "key", name: "people.title", permission: "people" },
];

export const isAllowed = ({ permission }: Place, role: Role): boolean =>
  permission === undefined || may(role, permission);

/** Whether `address` is the page at `href` or one below it. */
export const isAt = (address: string, href: string): boolean =>
  address === href || address.startsWith(`${href}/`);

/** The key of the study in an address; null on other pages. */
export function studyIn(address: string): string | null {
  const key = /^\/studies\/([^/?]+)/.exec(address)?.[1];
  return key === undefined ? null : decoded(key);
}

/** Whether an address can be read at all: a `%` in it begins the code of a character. */
export const isReadable = (address: string): boolean => decoded(address) !== null;

function decoded(text: string): string | null {
  try {
    return decodeURIComponent(text);
  } catch {
    return null;
  }
}

/** The section of a study at an address; a study's own address shows its overview. */
export function sectionAt(address: string): SectionName | null {
  const [, name] = /^\/studies\/[^/?]+(?:\/([^/?]+))?/.exec(address) ?? [null, null];
  if (name === null) return null;
  return SECTIONS.find(({ section }) => section === name)?.section ?? "overview";
}

/** Pages that need the width of the window: the sidebar shrinks to its icons there. */
export const isWide = (address: string): boolean =>
  /^\/(sessions\/|new\/|studies\/[^/]+\/edit|instruments\/(new|[^/]+\/edit)|avatars\/.)/.test(
    address,
  );
