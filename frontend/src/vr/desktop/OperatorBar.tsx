/**
 * What the experimenter presses next, on the participant's own page: whoever tries a study alone is
 * both, and would have to find the console's tab for every step.
 *
 * The session is read with this browser's sign-in, never with the participant's token: where nobody
 * is signed in who may run sessions, the bar says that the experimenter goes on.
 */
import { Anchor, Button } from "@mantine/core";
import { accounts, sessions } from "@shared/api/endpoints";
import { isApiError } from "@shared/api/request";
import type { SessionView } from "@shared/api/types";
import { wordsIn } from "@shared/i18n/words";
import { may } from "@shared/permissions";
import { isBlocked, primaryAction } from "@shared/session/nextAction";
import { registryDe, registryEn } from "@shared/session/registries.generated";
import { actionsDe, actionsEn } from "@shared/session/texts";
import { Icon } from "@shared/ui/Icon";
import { describe, errorTexts } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useMemo, useRef, useState } from "react";
import { useTexts } from "../i18n";
import classes from "./OperatorBar.module.css";

const EN = { ...actionsEn, ...registryEn };
const DE = { ...actionsDe, ...registryDe };
/** The next action follows within this time; somebody may sign in later. */
const POLL_MS = 2000;
const SIGNED_OUT_POLL_MS = 10_000;
/** A key that is hit twice must not press the next step's button. */
const ARM_AFTER_MS = 700;

interface OperatorBarProps {
  readonly sessionId: string;
  /** Nothing happens in the headset before somebody goes on. */
  readonly isWaiting: boolean;
}

export default function OperatorBar({ sessionId, isWaiting }: OperatorBarProps): JSX.Element {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const queryKey = ["operator", sessionId];
  const { data: session } = useQuery({
    queryKey,
    queryFn: () => readAsOperator(sessionId),
    retry: false,
    staleTime: 0,
    refetchInterval: ({ state }) => (state.data == null ? SIGNED_OUT_POLL_MS : POLL_MS),
  });
  const words = useMemo(
    () => wordsIn<typeof EN & typeof actionsEn>({ en: EN, de: DE }, language),
    [language],
  );
  // The step at which the last press failed: what is said about it goes when the next step comes.
  const [failedAt, setFailedAt] = useState<string | null>(null);
  const send = useMutation({
    mutationFn: (view: SessionView) => {
      const action = primaryAction(view);
      return action === null
        ? Promise.resolve(view)
        : sessions.command(view.id, view.version, action.command);
    },
    onSuccess: (view) => queries.setQueryData(queryKey, view),
    onError: (_, view) => {
      setFailedAt(nextOf(view));
      const read = queries.invalidateQueries({ queryKey });
      void read.then(() => setFailedAt(nextOf(queries.getQueryData<SessionView>(queryKey))));
    },
  });
  const action = session == null ? null : primaryAction(session);
  const canPress =
    session != null && action !== null && !isBlocked(session, action) && !send.isPending;
  const press = () => {
    if (session != null && canPress) send.mutate(session);
  };
  useEnter(press, action?.label ?? "");
  if (session === undefined) return <></>;
  if (session === null) {
    return isWaiting ? (
      <output className={classes.bar}>
        <span>{t("operator.waits")}</span>
        <Anchor href="/" target="_blank">
          {t("operator.signIn")}
        </Anchor>
      </output>
    ) : (
      <></>
    );
  }
  const isPast = failedAt !== nextOf(session);
  const failure = send.error === null || isPast ? null : describe(send.error, errorTexts(t));
  return (
    <section className={classes.bar} aria-label={t("operator.title")}>
      <span>
        {t(
          action === null ? (isWaiting ? "operator.elsewhere" : "operator.runs") : "operator.next",
        )}
      </span>
      {action !== null && (
        <Button
          size="sm"
          leftSection={<Icon name={action.icon} size={18} />}
          rightSection={<kbd>{t("operator.enter")}</kbd>}
          loading={send.isPending}
          disabled={!canPress && !send.isPending}
          onClick={press}
        >
          {words(action.label)}
        </Button>
      )}
      <Anchor href={`/#/sessions/${sessionId}`} target="_blank">
        {t("operator.console")}
      </Anchor>
      {failure !== null && (
        <span role="alert">
          {isApiError(send.error, "stale")
            ? t("operator.stale")
            : `${failure.message} ${failure.remedy ?? ""}`}
        </span>
      )}
    </section>
  );
}

/** What comes next in a session, as a key: its step, and what moves it on. */
export function nextOf(session: SessionView | null | undefined): string {
  if (session == null) return "";
  return `${session.current?.index ?? ""} ${primaryAction(session)?.label ?? ""}`;
}

/** The session as this browser's operator sees it; null if nobody is signed in who may run it. */
async function readAsOperator(sessionId: string): Promise<SessionView | null> {
  const { account } = await accounts.me();
  if (account === null || !may(account.role, "run")) return null;
  return sessions.get(sessionId).catch((error: unknown) => {
    // Studies of other people are not there for this account.
    if (isApiError(error)) return null;
    throw error;
  });
}

/** Enter presses the button, which a mouse that looks around cannot reach. */
function useEnter(press: () => void, label: string): void {
  const latest = useRef(press);
  const changedAt = useRef(0);
  useEffect(() => {
    latest.current = press;
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: the time is that of the label's change
  useEffect(() => {
    changedAt.current = performance.now();
  }, [label]);
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const isElsewhere =
        event.target instanceof HTMLElement && event.target.closest("button, a, input") !== null;
      if (event.key !== "Enter" || event.repeat || isElsewhere) return;
      if (performance.now() - changedAt.current < ARM_AFTER_MS) return;
      event.preventDefault();
      latest.current();
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  }, []);
}
