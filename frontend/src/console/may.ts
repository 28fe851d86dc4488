/**
 * Who may do what, so that nobody is shown a door that is locked for them. The server decides; this
 * table repeats the rows of `app/features/policy.py` that the console draws by, and a test compares.
 */
import type { Role } from "@shared/api/people";
import { useAccount } from "./account";

const ADMIN: readonly Role[] = ["admin"];
const DESIGNERS: readonly Role[] = ["admin", "experimenter"];
const RUNNERS: readonly Role[] = ["admin", "experimenter", "operator"];
const READERS: readonly Role[] = ["admin", "experimenter", "analyst"];

interface Rule {
  readonly roles: readonly Role[];
  /** The routes of the server that stand behind it; all of them are for these roles. */
  readonly routes: readonly string[];
}

export const RULES = {
  people: { roles: ADMIN, routes: ["GET /api/accounts", "GET /api/invitations", "GET /api/audit"] },
  design: {
    roles: DESIGNERS,
    routes: [
      "POST /api/studies",
      "POST /api/studies/{key}/versions",
      "POST /api/studies/{key}/archive",
      "POST /api/studies/{key}/restore",
      "POST /api/studies/{key}/duplicate",
      "POST /api/instruments",
      "POST /api/suggestions/{suggestion_id}/decision",
      "POST /api/calibrations",
      "POST /api/calibrations/{calibration_id}/retire",
    ],
  },
  run: {
    roles: RUNNERS,
    routes: [
      "POST /api/studies/{key}/sessions",
      "POST /api/sessions/{session_id}/commands",
      "POST /api/sessions/{session_id}/submissions",
      "POST /api/sessions/{session_id}/pairings",
      "DELETE /api/sessions/{session_id}/devices/{device_id}",
      "GET /api/sessions/{session_id}/consent",
      "POST /api/studies/{key}/suggestions",
    ],
  },
  network: { roles: RUNNERS, routes: ["GET /api/network"] },
  compare: {
    roles: READERS,
    routes: [
      "GET /api/studies/{key}/dashboard",
      "GET /api/studies/{key}/export",
      "GET /api/studies/{key}/codebook",
      "GET /api/studies/{key}/versions/{number}",
    ],
  },
  rights: {
    roles: DESIGNERS,
    routes: [
      "GET /api/studies/{key}/participants",
      "POST /api/studies/{key}/participants/{participant_id}/erasure",
      "GET /api/studies/{key}/participants/{participant_id}/access",
      "POST /api/sessions/{session_id}/submissions/{submission_id}/corrections",
      "GET /api/studies/{key}/copies",
      "POST /api/copies/{copy_id}/destroyed",
    ],
  },
  reveal: { roles: DESIGNERS, routes: ["POST /api/sessions/{session_id}/reveal"] },
} as const satisfies Readonly<Record<string, Rule>>;

export type Act = keyof typeof RULES;

export const may = (role: Role, act: Act): boolean => RULES[act].roles.includes(role);

/** What the person who is signed in may do. */
export function useMay(): (act: Act) => boolean {
  const role = useAccount().data?.role;
  return (act) => role !== undefined && may(role, act);
}
