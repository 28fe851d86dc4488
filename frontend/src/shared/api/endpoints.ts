/** Every request that the pages make, grouped by purpose. */
import { uuid } from "../uuid";
import { answer, server } from "./request";
import type {
  Account,
  Administration,
  Alarm,
  AvatarChoices,
  Check,
  CheckResult,
  CodebookColumn,
  Command,
  Device,
  FormStored,
  Kind,
  Ledger,
  Network,
  Pairing,
  Preflight,
  Receipt,
  RefusalWish,
  SessionEvent,
  SessionReceipt,
  SessionSummary,
  SessionView,
  StoredAnswers,
  StudyDetail,
  StudySummary,
  Submission,
  TabletState,
} from "./types";

const study = (key: string) => ({ params: { path: { key } } });
const session = (id: string) => ({ params: { path: { session_id: id } } });

export const accounts = {
  login: (username: string, password: string) =>
    answer<{ account: Account }>(server.POST("/api/login", { body: { username, password } })),
  logout: () => answer<void>(server.POST("/api/logout")),
  me: () => answer<{ account: Account | null }>(server.GET("/api/me")),
};

export const network = {
  get: () => answer<Network>(server.GET("/api/network")),
};

interface SessionWish {
  /** Repeating it returns the session that the first request made. */
  readonly request_id?: string;
  readonly participant_code: string | null;
  readonly kind: Kind;
  readonly language: string;
}

export const studies = {
  list: () => answer<readonly StudySummary[]>(server.GET("/api/studies")),
  check: (yaml: string) =>
    answer<CheckResult>(server.POST("/api/studies/check", { body: { yaml } })),
  add: (yaml: string) => answer<StudyDetail>(server.POST("/api/studies", { body: { yaml } })),
  /** `basedOn`: the newest version when the editing began; refused if there is a newer one. */
  addVersion: (key: string, yaml: string, basedOn: number | null = null) =>
    answer<StudyDetail>(
      server.POST("/api/studies/{key}/versions", {
        ...study(key),
        body: { yaml, based_on: basedOn },
      }),
    ),
  get: (key: string) => answer<StudyDetail>(server.GET("/api/studies/{key}", study(key))),
  ledger: (key: string, kind: Kind) =>
    answer<Ledger>(
      server.GET("/api/studies/{key}/ledger", { params: { path: { key }, query: { kind } } }),
    ),
  sessions: (key: string) =>
    answer<readonly SessionSummary[]>(server.GET("/api/studies/{key}/sessions", study(key))),
  join: (key: string, wish: SessionWish) =>
    answer<SessionView>(
      server.POST("/api/studies/{key}/sessions", {
        ...study(key),
        body: { time_scale: 1, ...wish },
      }),
    ),
  codebook: (key: string) =>
    answer<readonly CodebookColumn[]>(server.GET("/api/studies/{key}/codebook", study(key))),
};

const UNCHANGED = { casts: [], colliders: [], gains: [], layers: [], released: [] } as const;

export const sessions = {
  get: (id: string) => answer<SessionView>(server.GET("/api/sessions/{session_id}", session(id))),
  command: (id: string, expectedVersion: number, { avatar_changes, ...command }: Command) =>
    answer<SessionView>(
      server.POST("/api/sessions/{session_id}/commands", {
        ...session(id),
        body: {
          command_id: uuid(),
          expected_version: expectedVersion,
          ...command,
          ...(avatar_changes && { avatar_changes: { ...UNCHANGED, ...avatar_changes } }),
        },
      }),
    ),
  avatarChoices: (id: string) =>
    answer<AvatarChoices>(server.GET("/api/sessions/{session_id}/avatar-choices", session(id))),
  events: (id: string) =>
    answer<readonly SessionEvent[]>(server.GET("/api/sessions/{session_id}/events", session(id))),
  receipt: (id: string) =>
    answer<SessionReceipt>(server.GET("/api/sessions/{session_id}/receipt", session(id))),
  alarms: (id: string) =>
    answer<readonly Alarm[]>(server.GET("/api/sessions/{session_id}/alarms", session(id))),
  answers: (id: string) =>
    answer<readonly StoredAnswers[]>(server.GET("/api/sessions/{session_id}/answers", session(id))),
  pair: (id: string, device: Device) =>
    answer<Pairing>(
      server.POST("/api/sessions/{session_id}/pairings", { ...session(id), body: { device } }),
    ),
  revoke: (id: string, deviceId: string) =>
    answer<void>(
      server.DELETE("/api/sessions/{session_id}/devices/{device_id}", {
        params: { path: { session_id: id, device_id: deviceId } },
      }),
    ),
  administration: (id: string) =>
    answer<Administration | null>(
      server.GET("/api/sessions/{session_id}/administration", session(id)),
    ),
  answerHelp: (id: string) =>
    answer<void>(server.POST("/api/sessions/{session_id}/help/answered", session(id))),
  submit: (id: string, submission: Submission) =>
    answer<Receipt>(
      server.POST("/api/sessions/{session_id}/submissions", { ...session(id), body: submission }),
    ),
  preflight: (id: string) =>
    answer<Preflight>(server.GET("/api/sessions/{session_id}/preflight", session(id))),
  override: (id: string, check: Check["key"], reason: string) =>
    answer<Check>(
      server.POST("/api/sessions/{session_id}/preflight/overrides", {
        ...session(id),
        body: { check, reason },
      }),
    ),
  poseUrl: (id: string) => `/api/sessions/${encodeURIComponent(id)}/pose`,
  liveUrl: (id: string) => `/api/sessions/${encodeURIComponent(id)}/live`,
};

export const tablet = {
  pair: (code: string) =>
    answer<{ device: Device; session_id: string }>(
      server.POST("/api/devices/pair", { body: { code, name: "" } }),
    ),
  paired: () => answer<{ state: TabletState | null }>(server.GET("/api/tablet/paired")),
  state: () => answer<TabletState>(server.GET("/api/tablet/state")),
  setLanguage: (language: string) =>
    answer<TabletState>(server.PUT("/api/tablet/language", { body: { language } })),
  submit: (submission: Submission) =>
    answer<FormStored>(server.POST("/api/tablet/submissions", { body: submission })),
  help: (isCalling: boolean) =>
    answer<TabletState>(server.PUT("/api/tablet/help", { body: { asked: isCalling } })),
  question: (isAsked: boolean) =>
    answer<TabletState>(server.PUT("/api/tablet/question", { body: { asked: isAsked } })),
  refuse: (wish: RefusalWish) =>
    answer<TabletState>(server.PUT("/api/tablet/refusal", { body: wish })),
  acknowledge: (stepIndex: number) =>
    answer<TabletState>(
      server.POST("/api/tablet/acknowledge", { body: { step_index: stepIndex } }),
    ),
  liveUrl: "/api/tablet/live",
};
