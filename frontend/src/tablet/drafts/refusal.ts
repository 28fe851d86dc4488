/**
 * "I do not want to take part", until the server has recorded it.
 *
 * The refusal is stored on the tablet's disk before it is sent, and is resent until the server has
 * answered: after a lost answer, a reload, or ten minutes without a network. Each press has an id,
 * so
 * the server counts it once. Retracting it replaces a refusal that still waits; one that is already
 * on its way arrives first.
 */
import { tablet } from "@shared/api/endpoints";
import { ApiError } from "@shared/api/request";
import type { RefusalWish, TabletState } from "@shared/api/types";
import { uuid } from "@shared/uuid";
import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { STATE_KEY } from "../useTabletState";
import { drafts } from "./drafts";

const RETRY_MS = 3000;
const UNPAIRED = 401;
const TOO_MANY = 429;
const SERVER_AT_FAULT = 500;

export interface Refusal {
  /** The refusal or retraction that the server has not confirmed yet; null if there is none. */
  readonly waiting: RefusalWish | null;
  /** Whether sending has failed so far; it will be retried. */
  readonly failed: boolean;
  readonly setRefused: (refused: boolean) => void;
}

export function useRefusal({ session_id: sessionId, step_index }: TabletState): Refusal {
  const queries = useQueryClient();
  const [waiting, setWaiting] = useState<RefusalWish | null>(null);
  const [failed, setFailed] = useState(false);
  const inFlight = useRef<Promise<void>>(Promise.resolve());

  useEffect(() => {
    let cancelled = false;
    setWaiting(null);
    void drafts.wish(sessionId).then((kept) => {
      if (!cancelled && kept !== undefined) setWaiting((newer) => newer ?? kept);
    });
    return () => {
      cancelled = true;
    };
  }, [sessionId]);

  useEffect(() => {
    setFailed(false);
    if (waiting === null) return;
    let gone = false;
    let retry: ReturnType<typeof setTimeout> | undefined;
    const send = async (): Promise<void> => {
      if (gone) return;
      try {
        await drafts.keepWish(sessionId, waiting);
        queries.setQueryData<TabletState>(STATE_KEY, await tablet.refuse(waiting));
      } catch (error) {
        if (!isFinal(error)) {
          if (gone) return;
          setFailed(true);
          retry = setTimeout(attempt, RETRY_MS);
          return;
        }
        void queries.invalidateQueries({ queryKey: STATE_KEY });
      }
      await drafts.forgetWish(sessionId, waiting.wish_id);
      if (!gone) setWaiting(null);
    };
    const attempt = () => {
      inFlight.current = inFlight.current.then(send);
    };
    attempt();
    return () => {
      gone = true;
      clearTimeout(retry);
    };
  }, [waiting, sessionId, queries]);

  const setRefused = (refused: boolean) =>
    setWaiting({ wish_id: uuid(), step_index: step_index ?? 0, refused });
  return { waiting, failed, setRefused };
}

/** Whether the server has rejected it for good, so that resending is useless. */
export function isFinal(error: unknown): boolean {
  if (!(error instanceof ApiError)) return false;
  return error.status < SERVER_AT_FAULT && error.status !== UNPAIRED && error.status !== TOO_MANY;
}
