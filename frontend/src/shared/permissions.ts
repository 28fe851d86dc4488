/**
 * Who may do what, so that nobody is shown what they may not use. The server decides; this table
 * repeats the rows of `app/platform/policy.py` that the console needs, and a test compares both.
 */
import type { Role } from "./api/people";

const ADMIN: readonly Role[] = ["admin"];
const DESIGNERS: readonly Role[] = ["admin", "experimenter"];
const RUNNERS: readonly Role[] = ["admin", "experimenter", "operator"];
const READERS: readonly Role[] = ["admin", "experimenter", "analyst"];

interface Rule {
  readonly roles: readonly Role[];
  /** The server's routes that it needs, all of which are allowed for these roles. */
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
      "POST /api/studies/{key}/imports/look",
      "POST /api/studies/{key}/imports/check",
      "POST /api/studies/{key}/imports",
      "POST /api/studies/{key}/imports/{import_id}/undo",
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
      "GET /api/sessions/{session_id}/preflight",
      "POST /api/sessions/{session_id}/preflight/overrides",
      "POST /api/sessions/{session_id}/submissions",
      "POST /api/sessions/{session_id}/pairings",
      "DELETE /api/sessions/{session_id}/devices/{device_id}",
      "POST /api/sessions/{session_id}/help/answered",
      "GET /api/sessions/{session_id}/consent",
      "POST /api/studies/{key}/suggestions",
    ],
  },
  capture: {
    roles: DESIGNERS,
    routes: [
      "POST /api/captures",
      "PATCH /api/captures/{capture_id}",
      "DELETE /api/captures/{capture_id}",
      "PUT /api/captures/{capture_id}/joint-map",
      "DELETE /api/captures/{capture_id}/joint-map",
    ],
  },
  body: {
    roles: DESIGNERS,
    routes: [
      "POST /api/humanoids",
      "PATCH /api/humanoids/{content_hash}",
      "DELETE /api/humanoids/{content_hash}",
      "POST /api/humanoids/{content_hash}/measure",
      "POST /api/avatars",
      "POST /api/avatars/edit",
      "POST /api/avatars/check",
      "POST /api/avatars/{key}/versions",
    ],
  },
  walking: {
    roles: DESIGNERS,
    routes: [
      "POST /api/walking/scenes",
      "DELETE /api/walking/scenes/{scene_key}",
      "POST /api/walking/walk-sets",
      "POST /api/walking/walk-sets/tracks",
      "DELETE /api/walking/walk-sets/{set_id}",
      "POST /api/walking/models",
      "POST /api/walking/models/{model_id}/stop",
      "POST /api/walking/models/{model_id}/resume",
      "DELETE /api/walking/models/{model_id}",
    ],
  },
  openDoor: { roles: DESIGNERS, routes: ["PUT /api/trackers/doors/{door}"] },
  wearTracker: { roles: RUNNERS, routes: ["PUT /api/trackers/limbs"] },
  agreePose: { roles: RUNNERS, routes: ["POST /api/trackers/performers/pose"] },
  recordPerformer: {
    roles: DESIGNERS,
    routes: [
      "POST /api/trackers/recordings",
      "POST /api/trackers/recordings/{recording_id}/capture",
      "DELETE /api/trackers/recordings/{recording_id}",
    ],
  },
  network: { roles: RUNNERS, routes: ["GET /api/network"] },
  compare: {
    roles: READERS,
    routes: [
      "GET /api/studies/{key}/dashboard",
      "GET /api/studies/{key}/dashboard/{figure}/rows",
      "GET /api/studies/{key}/statistics",
      "GET /api/studies/{key}/preregistration",
      "GET /api/studies/{key}/preregistration/report",
      "GET /api/studies/{key}/imports",
      "GET /api/studies/{key}/imports/{import_id}",
      "GET /api/studies/{key}/imports/{import_id}/table",
      "GET /api/studies/{key}/export",
      "POST /api/studies/{key}/exports",
      "GET /api/exports",
      "DELETE /api/exports/{export_id}",
      "GET /api/exports/{export_id}/file",
      "GET /api/studies/{key}/codebook",
      "GET /api/studies/{key}/versions/{number}",
    ],
  },
  storage: { roles: DESIGNERS, routes: ["GET /api/storage"] },
  demo: { roles: DESIGNERS, routes: ["GET /api/demo", "POST /api/demo", "DELETE /api/demo"] },
  tryout: {
    roles: DESIGNERS,
    routes: ["POST /api/studies/{key}/tryout", "GET /api/tryout", "DELETE /api/tryout"],
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

export type Permission = keyof typeof RULES;

export const may = (role: Role, act: Permission): boolean => RULES[act].roles.includes(role);
