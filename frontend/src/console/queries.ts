/** The console's reads of the server, each with the key under which it is kept. */
import { network, sessions, studies } from "@shared/api/endpoints";
import type { Kind } from "@shared/api/types";
import { keepPreviousData, queryOptions } from "@tanstack/react-query";

/** Looked at again now and then: a laptop that joins another network gets other addresses. */
export const networkQuery = queryOptions({
  queryKey: ["network"],
  queryFn: network.get,
  refetchInterval: 30_000,
});

export const studiesQuery = queryOptions({ queryKey: ["studies"], queryFn: studies.list });

export const studyQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key], queryFn: () => studies.get(key) });

export const ledgerQuery = (key: string, kind: Kind) =>
  queryOptions({
    queryKey: ["studies", key, "ledger", kind],
    queryFn: () => studies.ledger(key, kind),
  });

export const sessionsQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key, "sessions"], queryFn: () => studies.sessions(key) });

export const dashboardQuery = (key: string, kind: Kind) =>
  queryOptions({
    queryKey: ["studies", key, "dashboard", kind],
    queryFn: () => studies.dashboard(key, kind),
  });

export const sessionQuery = (id: string) =>
  queryOptions({ queryKey: ["sessions", id], queryFn: () => sessions.get(id) });

export const answersQuery = (id: string, version: number) =>
  queryOptions({
    queryKey: ["sessions", id, "answers", version],
    queryFn: () => sessions.answers(id),
  });

export const eventsQuery = (id: string, version: number) =>
  queryOptions({
    queryKey: ["sessions", id, "events", version],
    queryFn: () => sessions.events(id),
  });

/** `state` changes whenever an alarm begins or ends. */
export const alarmsQuery = (id: string, state: string) =>
  queryOptions({
    queryKey: ["sessions", id, "alarms", state],
    queryFn: () => sessions.alarms(id),
    placeholderData: keepPreviousData,
  });

export const codebookQuery = (key: string) =>
  queryOptions({
    queryKey: ["studies", key, "codebook"],
    queryFn: () => studies.codebook(key),
    staleTime: Number.POSITIVE_INFINITY,
  });
