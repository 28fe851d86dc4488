/** Which kind of session a study's pages show: kept in the address, and from page to page. */
import { DEMO_KEY } from "@shared/api/housekeeping";
import type { DataKind } from "@shared/api/types";
import { useEffect } from "react";
import { useLocation, useSearch } from "wouter";
import { useKeptSearch } from "../frame/ownSearch";

const KINDS: readonly string[] = ["people", "simulated", "test"] satisfies readonly DataKind[];

/** Whether a text names a kind of data. */
const isKind = (text: string | null): text is DataKind => text !== null && KINDS.includes(text);

const nameOf = (studyKey: string): string => `reembody.kind.${studyKey}`;

/**
 * The kind that a study's pages show: the address's, else the one last shown in this browser,
 * else participants.
 */
export function kindOf(studyKey: string, search: string): DataKind {
  const given = new URLSearchParams(search).get("kind");
  if (isKind(given)) return given;
  const last = localStorage.getItem(nameOf(studyKey));
  // The demo lab has simulated people only, and a page without data would be a poor welcome.
  return isKind(last) ? last : studyKey === DEMO_KEY ? "simulated" : "people";
}

/** Remember a kind for the study's other pages. */
export function useRememberedKind(studyKey: string, kind: DataKind): void {
  useEffect(() => localStorage.setItem(nameOf(studyKey), kind), [studyKey, kind]);
}

/** The chosen kind, and how to choose another. */
export function useKind(studyKey: string): readonly [DataKind, (kind: DataKind) => void] {
  const [place, navigate] = useLocation();
  const kind = kindOf(studyKey, useSearch());
  useRememberedKind(studyKey, kind);
  // Replace the address: going back leaves the page instead of undoing a choice.
  return [kind, (next) => navigate(`${place}?kind=${next}`, { replace: true })];
}

/** Keep what else the page's address chooses, for when it is opened again in this tab. */
export const useOwnSearch = (): void => useKeptSearch(["kind"]);
