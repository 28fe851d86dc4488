/** A session as the server sees it, kept current by its live feed, and its commands. */
import { sessions } from "@shared/api/endpoints";
import { type FeedState, openFeed } from "@shared/api/live";
import { isApiError, isUnauthorised } from "@shared/api/request";
import type {
  Command,
  FailingNews,
  SessionView,
  StorageNews,
  TelemetryNews,
} from "@shared/api/types";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo, useState } from "react";
import { checkSignIn } from "../../account";
import type { Key } from "../../i18n";
import { sessionQuery } from "../../queries";
import { CALLS, type Storage } from "../alarms/alarms";
import { TelemetryStore } from "./telemetryStore";

/** A command that came too late: another operator was first. */
interface Overtaken {
  readonly command: Command;
  readonly changes: readonly Change[];
}

/** A command and the view on which it was decided. */
interface Sent {
  readonly view: SessionView;
  readonly command: Command;
}

/**
 * Commands that stop something never wait for another one that is under way, such as a note on a
 * slow network. The server accepts them on any version of the session.
 */
export const stops = ({ type }: Pick<Command, "type">): boolean =>
  type === "pause" || type === "abort" || type === "withdraw";

export type Send = (command: Command, onDone?: () => void) => void;

export function useSession(id: string) {
  const queries = useQueryClient();
  const query = useQuery(sessionQuery(id));
  const store = useMemo(() => new TelemetryStore(), []);
  const [storage, setStorage] = useState<Storage | null>(null);
  const [failing, setFailing] = useState<readonly FailingNews[]>([]);
  const [feed, setFeed] = useState<FeedState>("connecting");
  const [overtaken, setOvertaken] = useState<Overtaken | null>(null);
  const { queryKey } = sessionQuery(id);

  const accept = (view: SessionView) =>
    queries.setQueryData<SessionView>(queryKey, (previous) => newer(previous, view));

  // biome-ignore lint/correctness/useExhaustiveDependencies: one feed for one session
  useEffect(
    () =>
      openFeed({
        url: sessions.liveUrl(id),
        onState: (state) => {
          setFeed(state);
          // A feed does not say why it ended: the sign-in may have been ended elsewhere.
          if (state === "lost") void checkSignIn(queries);
        },
        on: {
          session: (data) => accept(data as SessionView),
          telemetry: (data) => store.put(data as TelemetryNews),
          storage: (data) =>
            setStorage({ news: data as StorageNews, receivedAt: new Date().toISOString() }),
          background: (data) => setFailing(data as readonly FailingNews[]),
        },
      }),
    [id],
  );

  const order = {
    mutationFn: ({ view, command }: Sent) => sessions.command(id, view.version, command),
    onSuccess: (view: SessionView) => {
      setOvertaken(null);
      accept(view);
    },
    onError: async (error: Error, sent: Sent) => {
      if (!isApiError(error, "stale")) return;
      overtake(sent, await sessions.get(id));
    },
  };
  const command = useMutation(order);
  const stop = useMutation(order);

  const overtake = (sent: Sent, fresh: SessionView) => {
    accept(fresh);
    setOvertaken({ command: sent.command, changes: changesBetween(sent.view, fresh) });
  };

  const send: Send = (order, onDone) => {
    const [way, other] = stops(order) ? [stop, command] : [command, stop];
    if (query.data === undefined || way.isPending) return;
    if (!other.isPending) other.reset();
    way.mutate({ view: query.data, command: order }, { onSuccess: () => onDone?.() });
  };

  /**
   * Send a command that was prepared on `seen`, with reasons that have changed the version since.
   */
  const resend = async (preparedOn: SessionView, order: Command): Promise<void> => {
    const done = await resendOnLatestVersion(sessions, preparedOn, order);
    if (done.overtaken) return overtake({ view: preparedOn, command: order }, done.view);
    setOvertaken(null);
    accept(done.view);
  };

  return {
    query,
    store,
    storage,
    failing,
    feed,
    send,
    sendAnew: resend,
    sending: command.isPending,
    stopping: stop.isPending,
    error:
      [stop, command]
        .filter(({ variables }) => !isOutdated(variables, query.data))
        .map(({ error }) => error)
        .find((error) => error !== null && !isShownElsewhere(error)) ?? null,
    overtaken,
    dismiss: () => {
      command.reset();
      stop.reset();
      setOvertaken(null);
    },
  };
}

/** Errors that the page shows elsewhere. */
const isShownElsewhere = (error: unknown): boolean =>
  isApiError(error, "stale") || isUnauthorised(error);

/**
 * Whether the session has moved on since a command was sent: its failure is then no longer shown.
 */
export function isOutdated(
  sent: { readonly view: SessionView } | undefined,
  now: SessionView | undefined,
): boolean {
  if (sent === undefined || now === undefined) return false;
  const { view } = sent;
  return view.status !== now.status || view.current?.index !== now.current?.index;
}

/**
 * The newer of two views: answers and live events may overtake each other, so the higher version
 * wins.
 */
function newer(previous: SessionView | undefined, view: SessionView): SessionView {
  return previous !== undefined && previous.version > view.version ? previous : view;
}

/**
 * The result of a command that was prepared for a while, during which reasons were written and
 * recorded.
 *
 * Notes and reasons, one's own and those of another operator, change the version of a session but
 * nothing that the command depends on. So it is resent on the newest version for as long as the
 * session's status is the one for which the command was prepared.
 */
interface Resent {
  readonly view: SessionView;
  /** Another operator was first: the status has changed, and nothing was sent. */
  readonly overtaken: boolean;
}

/** The most attempts: few operators write notes, and each writes one at a time. */
const MAX_ATTEMPTS = 20;

/**
 * Resend a command on the latest version; throws other refusals, and `stale` if notes never stop.
 */
export async function resendOnLatestVersion(
  api: Pick<typeof sessions, "get" | "command">,
  preparedOn: SessionView,
  order: Command,
): Promise<Resent> {
  for (let time = 1; ; time += 1) {
    const fresh = await api.get(preparedOn.id);
    if (fresh.status !== preparedOn.status) return { view: fresh, overtaken: true };
    try {
      return { view: await api.command(preparedOn.id, fresh.version, order), overtaken: false };
    } catch (error) {
      if (!isApiError(error, "stale") || time === MAX_ATTEMPTS) throw error;
    }
  }
}

interface Change {
  readonly key: Key;
  readonly values?: Readonly<Record<string, string | number>>;
}

/** What another operator changed between two views of a session, in the texts of the console. */
export function changesBetween(before: SessionView, after: SessionView): readonly Change[] {
  const changes: Change[] = [];
  if (before.status !== after.status) changes.push({ key: `change.status.${after.status}` });
  const step = after.current?.index;
  if (step !== undefined && step !== before.current?.index) {
    changes.push({ key: "change.step", values: { number: step + 1 } });
  } else if (after.current !== null && before.current?.status !== after.current.status) {
    changes.push({ key: `change.phase.${after.current.status}` });
  }
  if (before.refusal === null && after.refusal !== null) changes.push({ key: "change.refused" });
  if (before.refusal !== null && after.refusal === null && after.current !== null) {
    changes.push({ key: "change.retracted" });
  }
  if (calls(after) && !calls(before)) changes.push({ key: "change.question" });
  const added = after.notes.length - before.notes.length;
  if (added > 0) changes.push({ key: "change.notes", values: { count: added } });
  return changes.length === 0 ? [{ key: "change.other" }] : changes;
}

const calls = ({ alarms }: SessionView): boolean =>
  alarms.some(({ code }) => CALLS.some((one) => one === code));
