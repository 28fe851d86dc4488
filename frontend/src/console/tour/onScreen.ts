/**
 * The study on this screen: this browser takes the headset's place, in a tab of its own.
 *
 * Either for a session that is there, or for a test session that is made for it and begins where
 * there is something to act in.
 */
import { sessions, studies } from "@shared/api/endpoints";
import type { SessionView } from "@shared/api/types";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { sessionQuery } from "../queries";
import { isTimed } from "../steps";
import { studyLanguage } from "./TryIt";

/** Pairs this browser as the headset of a session; give `opened()` to it in the click itself. */
export function useOpenOnScreen() {
  return useMutation({
    mutationFn: ({ sessionId, tab }: { readonly sessionId: string; readonly tab: Window | null }) =>
      closedOnFailure(tab, () => open(sessionId, tab)),
  });
}

/** A tab for the study, still empty: browsers block tabs that are opened later than in a click. */
export const opened = (): Window | null => window.open("about:blank", "_blank");

/** Makes a test session, goes to it, and opens it on this screen just before its first body. */
export function useActOnScreen() {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const [, navigate] = useLocation();
  const reason = t("acting.skipped");
  return useMutation({
    mutationFn: ({ studyKey, tab }: { readonly studyKey: string; readonly tab: Window | null }) =>
      closedOnFailure(tab, async () => {
        const study = await studies.get(studyKey);
        const made = await studies.join(studyKey, {
          participant_code: null,
          kind: "test",
          language: studyLanguage(study.languages, language),
        });
        const session = await atFirstBody(made, reason);
        await open(session.id, tab);
        return session;
      }),
    onSuccess: (session) => {
      queries.setQueryData(sessionQuery(session.id).queryKey, session);
      void queries.invalidateQueries({ queryKey: ["studies"] });
      navigate(`/sessions/${session.id}`);
    },
  });
}

/** Start a session and skip what comes before the first step with a body, if there is one. */
async function atFirstBody(made: SessionView, reason: string): Promise<SessionView> {
  const hasBody = ({ kind }: SessionView["steps"][number]) =>
    kind === "materialise" || isTimed({ kind });
  const goal = made.steps.findIndex(hasBody);
  let session = await sessions.command(made.id, made.version, { type: "start" });
  while (session.current !== null && session.current.index < goal) {
    session = await sessions.command(made.id, session.version, { type: "skip", reason });
  }
  return session;
}

async function open(sessionId: string, tab: Window | null): Promise<void> {
  const { code } = await sessions.pair(sessionId, "headset");
  if (tab !== null) tab.location.href = `/vr?screen=desktop&code=${code}`;
}

async function closedOnFailure<T>(tab: Window | null, work: () => Promise<T>): Promise<T> {
  try {
    return await work();
  } catch (error) {
    tab?.close();
    throw error;
  }
}
