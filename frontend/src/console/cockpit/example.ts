/** A small session for tests: consent, then one block of a hand task and its questionnaire. */
import type { Current, SessionView, Step } from "@shared/api/types";

const step = (index: number, kind: Step["kind"], more: Partial<Step> = {}): Step => ({
  index,
  key: `${index}`,
  kind,
  title: kind,
  block: null,
  latency_ms: null,
  body: null,
  limb: null,
  preparation_s: null,
  duration_s: null,
  freeze_s: null,
  instrument: null,
  status: "pending",
  attempt: 1,
  reason: null,
  forms: "tablet",
  ...more,
});

const IN_BLOCK = { block: 0, latency_ms: 125 } as const;

export const steps: readonly Step[] = [
  step(0, "consent"),
  step(1, "height"),
  step(2, "task", { ...IN_BLOCK, limb: "hand", duration_s: 60 }),
  step(3, "questionnaire", { ...IN_BLOCK, limb: "hand" }),
  step(4, "task", { block: 1, latency_ms: 0, limb: "foot", duration_s: 60 }),
  step(5, "debrief"),
];

export const at = (index: number, more: Partial<Current> = {}): Current => ({
  index,
  status: "ready",
  active_s: 0,
  duration_s: null,
  pausing: false,
  resuming: false,
  pause_reason: null,
  ...more,
});

export const session: SessionView = {
  id: "s",
  study_key: "study",
  study_title: { en: "Study", de: "Studie" },
  study_version: 1,
  participant_code: "P-1",
  kind: "people",
  simulated: false,
  held: null,
  refusal: null,
  blinded: false,
  avatar: "delayed_copy",
  avatar_configuration_hash: null,
  avatar_version: null,
  language: "en",
  version: 1,
  status: "active",
  time_scale: 1,
  created_at: "2026-01-01T12:00:00Z",
  started_at: "2026-01-01T12:00:00Z",
  ended_at: null,
  sequence: [125, 0],
  slot: { index: 0, block: 0, replicate: 1 },
  steps,
  current: at(0),
  allowed: [],
  devices: [],
  phases: [],
  alarms: [],
  notes: [],
  scores: [],
  shortfalls: null,
};
