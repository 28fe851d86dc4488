/** Every request the pages make, by what it is for. */
import { uuid } from "../uuid";
import { request } from "./request";
import type {
  Account,
  Administration,
  CheckResult,
  Command,
  Dashboard,
  Device,
  Kind,
  Ledger,
  Pairing,
  Receipt,
  SessionEvent,
  SessionSummary,
  SessionView,
  StudyDetail,
  StudySummary,
  Submission,
  TabletState,
} from "./types";

const study = (key: string): string => `/api/studies/${encodeURIComponent(key)}`;
const session = (id: string): string => `/api/sessions/${encodeURIComponent(id)}`;

export const accounts = {
  login: (username: string, password: string) =>
    request<{ account: Account }>("POST", "/api/login", { username, password }),
  logout: () => request<void>("POST", "/api/logout"),
  me: () => request<{ account: Account }>("GET", "/api/me"),
};

export const studies = {
  list: () => request<readonly StudySummary[]>("GET", "/api/studies"),
  check: (yaml: string) => request<CheckResult>("POST", "/api/studies/check", { yaml }),
  add: (yaml: string) => request<StudyDetail>("POST", "/api/studies", { yaml }),
  addVersion: (key: string, yaml: string) =>
    request<StudyDetail>("POST", `${study(key)}/versions`, { yaml }),
  get: (key: string) => request<StudyDetail>("GET", study(key)),
  ledger: (key: string, kind: Kind) => request<Ledger>("GET", `${study(key)}/ledger?kind=${kind}`),
  sessions: (key: string, kind?: Kind) =>
    request<readonly SessionSummary[]>(
      "GET",
      `${study(key)}/sessions${kind === undefined ? "" : `?kind=${kind}`}`,
    ),
  join: (
    key: string,
    wish: { participant_code: string | null; kind: Kind; language: string; time_scale?: number },
  ) => request<SessionView>("POST", `${study(key)}/sessions`, wish),
  dashboard: (key: string, kind: Kind) =>
    request<Dashboard>("GET", `${study(key)}/dashboard?kind=${kind}`),
  exportUrl: (key: string, kind: Kind) => `${study(key)}/export?kind=${kind}`,
  codebookUrl: (key: string) => `${study(key)}/codebook`,
};

export const sessions = {
  get: (id: string) => request<SessionView>("GET", session(id)),
  command: (id: string, expectedVersion: number, command: Command) =>
    request<SessionView>("POST", `${session(id)}/commands`, {
      command_id: uuid(),
      expected_version: expectedVersion,
      ...command,
    }),
  events: (id: string) => request<readonly SessionEvent[]>("GET", `${session(id)}/events`),
  pair: (id: string, device: Device) =>
    request<Pairing>("POST", `${session(id)}/pairings`, { device }),
  revoke: (id: string, deviceId: string) =>
    request<void>("DELETE", `${session(id)}/devices/${encodeURIComponent(deviceId)}`),
  administration: (id: string) =>
    request<(Administration & { languages: readonly string[] }) | null>(
      "GET",
      `${session(id)}/administration`,
    ),
  submit: (id: string, submission: Submission) =>
    request<Receipt>("POST", `${session(id)}/submissions`, submission),
  liveUrl: (id: string) => `${session(id)}/live`,
};

export const tablet = {
  pair: (code: string) =>
    request<{ device: Device; session_id: string; token: string | null }>(
      "POST",
      "/api/devices/pair",
      { code },
    ),
  state: () => request<TabletState>("GET", "/api/tablet/state"),
  setLanguage: (language: string) =>
    request<TabletState>("PUT", "/api/tablet/language", { language }),
  submit: (submission: Submission) =>
    request<Receipt>("POST", "/api/tablet/submissions", submission),
  acknowledge: (stepIndex: number) =>
    request<TabletState>("POST", "/api/tablet/acknowledge", { step_index: stepIndex }),
  liveUrl: "/api/tablet/live",
};
