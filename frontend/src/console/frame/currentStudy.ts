/** The study whose sections the sidebar shows: the open one, else the one that was open last. */

import { inLanguage } from "@shared/text";
import { useQuery } from "@tanstack/react-query";
import { useEffect } from "react";
import { useTexts } from "../i18n";
import { sessionQuery, studiesQuery } from "../queries";
import { studyIn } from "./places";

const REMEMBERED = "reembody.study";

/** The study that was open last in this browser; null if none was. */
export const lastStudy = (): string | null => localStorage.getItem(REMEMBERED);

export interface CurrentStudy {
  readonly key: string;
  /** Null until the list of studies has arrived, or where the study is archived. */
  readonly title: string | null;
}

/**
 * The current study at an address; null while none is known.
 *
 * A session belongs to its study, which its page has requested anyway.
 */
export function useCurrentStudy(address: string): CurrentStudy | null {
  const { language } = useTexts();
  const listed = useQuery(studiesQuery).data;
  const id = /^\/sessions\/([^/?]+)/.exec(address)?.[1];
  const session = useQuery({ ...sessionQuery(id ?? ""), enabled: false }).data;
  const open = studyIn(address) ?? session?.study_key ?? null;
  useEffect(() => {
    if (open !== null) localStorage.setItem(REMEMBERED, open);
  }, [open]);
  const last = lastStudy();
  const known = (key: string | null): boolean =>
    key !== null && (listed === undefined || listed.some((study) => study.key === key));
  const key = open ?? (known(last) ? last : (listed?.[0]?.key ?? null));
  if (key === null) return null;
  const found = listed?.find((study) => study.key === key);
  return { key, title: found === undefined ? null : inLanguage(found.titles, language) };
}
