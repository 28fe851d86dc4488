/** The console's queries to the server, each with its cache key. */
import {
  analysis,
  awaitsFirstFigure,
  type FigureGroup,
  type Filter,
  preregistrations,
} from "@shared/api/analysis";
import { companions } from "@shared/api/companion";
import { drafts, instruments, versions } from "@shared/api/drafts";
import { network, sessions, studies } from "@shared/api/endpoints";
import { demo, exports, lab, storageRoom, tryouts } from "@shared/api/housekeeping";
import { type ImportMapping, imports } from "@shared/api/imports";
import { type AuditFilter, audit, invitations, people } from "@shared/api/people";
import { performers } from "@shared/api/performers";
import { calibrations, consents, selfTests, suggestions } from "@shared/api/records";
import { rights } from "@shared/api/rights";
import { road } from "@shared/api/road";
import { trackers } from "@shared/api/trackers";
import type { DataKind, Kind } from "@shared/api/types";
import { infiniteQueryOptions, keepPreviousData, queryOptions } from "@tanstack/react-query";

/** Refreshed now and then: a laptop that joins another network gets other addresses. */
export const networkQuery = queryOptions({
  queryKey: ["network"],
  queryFn: network.get,
  refetchInterval: 30_000,
});

export const studiesQuery = queryOptions({ queryKey: ["studies"], queryFn: studies.list });

export const archivedQuery = queryOptions({
  queryKey: ["studies", "", "archived"],
  queryFn: versions.archived,
});

export const templatesQuery = queryOptions({
  queryKey: ["templates"],
  queryFn: drafts.templates,
  staleTime: Number.POSITIVE_INFINITY,
});

export const instrumentsQuery = queryOptions({
  queryKey: ["instruments"],
  queryFn: instruments.list,
});

export const instrumentQuery = (key: string) =>
  queryOptions({ queryKey: ["instruments", key], queryFn: () => instruments.get(key) });

export const versionDiffQuery = (key: string, from: number, to: number) =>
  queryOptions({
    queryKey: ["studies", key, "diff", from, to],
    queryFn: () => versions.diff(key, from, to),
  });

export const studyQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key], queryFn: () => studies.get(key) });

export const ledgerQuery = (key: string, kind: Kind) =>
  queryOptions({
    queryKey: ["studies", key, "ledger", kind],
    queryFn: () => studies.ledger(key, kind),
  });

export const sessionsQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key, "sessions"], queryFn: () => studies.sessions(key) });

export const dashboardQuery = (key: string, filter: Filter, group: FigureGroup) =>
  queryOptions({
    queryKey: ["studies", key, "dashboard", filter, group],
    queryFn: () => analysis.dashboard(key, filter, group),
    // The server returns the last figures it drew, and redraws them if there are newer data.
    refetchInterval: ({ state }) =>
      state.data?.current === false ? 1500 : awaitsFirstFigure(state.data) ? 3000 : false,
    placeholderData: keepPreviousData,
  });

export const statisticsQuery = (key: string, kind: DataKind) =>
  queryOptions({
    queryKey: ["studies", key, "statistics", kind],
    queryFn: () => analysis.statistics(key, kind),
    refetchInterval: ({ state }) => (state.data?.current === false ? 1500 : false),
  });

export const preregistrationQuery = (key: string, kind: DataKind) =>
  queryOptions({
    queryKey: ["studies", key, "preregistration", kind],
    queryFn: () => preregistrations.get(key, kind),
  });

/** Kept for a day, so that a page whose sign-in has expired is restored with what was typed. */
export const sessionQuery = (id: string) =>
  queryOptions({
    queryKey: ["sessions", id],
    queryFn: () => sessions.get(id),
    gcTime: 24 * 60 * 60_000,
  });

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

/** Counted anew whenever it is opened: what a headset has yet to send changes no version. */
export const receiptQuery = (id: string, version: number) =>
  queryOptions({
    queryKey: ["sessions", id, "receipt", version],
    queryFn: () => sessions.receipt(id),
    staleTime: 0,
  });

/** `state` changes whenever an alarm starts or ends. */
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

export const consentQuery = (id: string) =>
  queryOptions({ queryKey: ["sessions", id, "consent"], queryFn: () => consents.ofSession(id) });

export const suggestionsQuery = (key: string) =>
  queryOptions({
    queryKey: ["studies", key, "suggestions"],
    queryFn: () => suggestions.ofStudy(key),
  });

export const calibrationsQuery = queryOptions({
  queryKey: ["calibrations"],
  queryFn: calibrations.list,
});

export const selfTestsQuery = queryOptions({
  queryKey: ["headset-tests"],
  queryFn: selfTests.list,
});

/** Asked again every second while the page is shown: what arrives is watched as it happens. */
export const trackersQuery = queryOptions({
  queryKey: ["trackers"],
  queryFn: trackers.get,
  refetchInterval: 1000,
});

/** Asked again every second, as the sources are: a recording's time goes on. */
export const performersQuery = queryOptions({
  queryKey: ["performers"],
  queryFn: performers.get,
  refetchInterval: 1000,
});

/** Asked again every second: the operator watches how the participant looks around. */
export const sessionTrackersQuery = (sessionId: string) =>
  queryOptions({
    queryKey: ["session-trackers", sessionId],
    queryFn: () => trackers.ofSession(sessionId),
    refetchInterval: 1000,
  });

/** Asked again every second: the operator sees whether the participant is shown somebody. */
export const sessionCompanionQuery = (sessionId: string) =>
  queryOptions({
    queryKey: ["session-companion", sessionId],
    queryFn: () => companions.ofSession(sessionId),
    refetchInterval: 1000,
  });

export const sessionRoadQuery = (sessionId: string) =>
  queryOptions({
    queryKey: ["session-road", sessionId],
    queryFn: () => road.ofSession(sessionId),
    // Of a study without a road nothing ever changes.
    refetchInterval: ({ state }) => (state.data?.has_road === false ? false : 1000),
  });

export const peopleQuery = queryOptions({ queryKey: ["people"], queryFn: people.list });

export const invitationsQuery = queryOptions({
  queryKey: ["invitations"],
  queryFn: invitations.list,
});

export const auditQuery = (filter: AuditFilter) =>
  infiniteQueryOptions({
    queryKey: ["audit", filter.actor, filter.action],
    queryFn: ({ pageParam }) => audit.page(filter, pageParam),
    initialPageParam: null as number | null,
    getNextPageParam: (page) => page.next_before,
  });

export const participantsQuery = (key: string) =>
  queryOptions({
    queryKey: ["studies", key, "participants"],
    queryFn: () => rights.participants(key),
  });

/** All answers of a session, with the wordings; they change with each correction. */
export const formsQuery = (id: string) =>
  queryOptions({ queryKey: ["sessions", id, "forms"], queryFn: () => rights.answers(id) });

export const preflightQuery = (id: string) =>
  queryOptions({ queryKey: ["preflight", id], queryFn: () => sessions.preflight(id) });

/** Refreshed while a file is being made. */
export const exportsQuery = queryOptions({
  queryKey: ["exports"],
  queryFn: exports.list,
  refetchInterval: ({ state }) =>
    state.data?.some(({ state: one }) => one === "queued" || one === "making") ? 700 : false,
});

export const storageQuery = queryOptions({
  queryKey: ["storage"],
  queryFn: () => storageRoom.get(false),
  refetchInterval: 60_000,
});

/** Asked again while its simulated people are on their way. */
export const demoQuery = queryOptions({
  queryKey: ["demo"],
  queryFn: demo.get,
  refetchInterval: ({ state }) => (state.data?.state === "loading" ? 1000 : false),
});

/** `since`: where the reader's day begins. */
export const labQuery = (since: string) =>
  queryOptions({
    queryKey: ["studies", "", "lab", since],
    queryFn: () => lab.get(since),
    refetchInterval: 15_000,
  });

export const tryoutQuery = queryOptions({
  queryKey: ["tryout"],
  queryFn: tryouts.newest,
  refetchInterval: ({ state }) =>
    state.data?.state === "starting" ? 400 : state.data?.state === "running" ? 1500 : false,
});

/** Queries of imported answers, each with its cache key. */
export const importsQuery = (key: string) =>
  queryOptions({ queryKey: ["studies", key, "imports"], queryFn: () => imports.list(key) });

export const importQuery = (key: string, id: string) =>
  queryOptions({
    queryKey: ["studies", key, "imports", id],
    queryFn: () => imports.get(key, id),
  });

/** `file` identifies the text, which is long. */
export const checkQuery = (key: string, file: string, text: string, mapping: ImportMapping) =>
  queryOptions({
    queryKey: ["studies", key, "import-check", file, mapping],
    queryFn: () => imports.check(key, text, mapping),
    placeholderData: keepPreviousData,
    retry: false,
    gcTime: 60_000,
  });
