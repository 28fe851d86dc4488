/**
 * Which panel the participant needs now, from the state of the session and of the headset: one at a
 * time, the most important first. A value, so that the panel is made anew only when it changes.
 */
import type { Pause } from "../../panels";
import type { PanelOrder } from "../../telemetry";
import type { BoundaryProblem } from "../../world";
import type { Place } from "../ports";

/** What the choice depends on. */
export interface Situation {
  readonly place: Place;
  /** The panel of the newest state; null from a server that sends none. */
  readonly order: PanelOrder | null;
  readonly stepKind: string | null;
  readonly stepIndex: number | null;
  /** Where the running phase is; null between phases. */
  readonly phase: "to_start" | "preparing" | "running" | "walk_back" | "frozen" | "paused" | null;
  /** Whether the headset measures both feet now. */
  readonly areFeetTracked: boolean;
  /** The lab's trackers are not aligned yet: the wearer has to look around. */
  readonly looksAround: boolean;
  /** Whole seconds until a phase begins, null while it waits for cars; 0 otherwise. */
  readonly secondsLeft: number | null;
  /** How far the call of somebody who has stopped has come; null while nobody has. */
  readonly stop: "telling" | "told" | "untold" | null;
  /** The connection has been down for a while. */
  readonly isOffline: boolean;
  readonly isNearEdge: boolean;
  /** What is wrong with the guarded space, until somebody goes on regardless. */
  readonly boundary: BoundaryProblem;
}

export type Wanted =
  | { readonly kind: "nothing" }
  | { readonly kind: "edge" }
  | { readonly kind: "boundary"; readonly problem: "missing" | "too_small" }
  | { readonly kind: "pause"; readonly pause: Pause }
  | { readonly kind: "offline" | "finished" | "standby" | "aloud" | "stepping_in" | "look_around" }
  | { readonly kind: "form"; readonly form: string }
  | { readonly kind: "reading"; readonly stepIndex: number; readonly text: string }
  | { readonly kind: "take_off"; readonly isForm: boolean }
  | { readonly kind: "feet" }
  | { readonly kind: "ready" }
  | { readonly kind: "to_start" }
  | { readonly kind: "preparing"; readonly secondsLeft: number | null }
  | { readonly kind: "screen_text"; readonly text: "freeze" | "walk_back" }
  | { readonly kind: "waiting" };

const NOTHING: Wanted = { kind: "nothing" };

/** Decide. */
export function wanted(now: Situation): Wanted {
  const { order, phase } = now;
  if (now.isNearEdge && now.place !== "over") return { kind: "edge" };
  if (now.stop !== null) return { kind: "pause", pause: { by: "participant", call: now.stop } };
  if (now.place === "over") return { kind: "finished" };
  // A form goes on without a connection, and so does a phase that the study lets go on.
  const waitsForServer = phase === null || phase === "paused" || isBefore(phase);
  if (now.isOffline && waitsForServer && order?.form == null) return { kind: "offline" };
  if (phase !== null) return inPhase(now, phase);
  if (order === null) return now.place === "stepping_in" ? { kind: "stepping_in" } : NOTHING;
  // Whoever has something to answer, or to do outside, looks around afterwards.
  const isBusy = order.held || order.headset_off || order.answer !== null || order.acknowledge;
  if (now.looksAround && !isBusy) return { kind: "look_around" };
  if (now.boundary !== null && now.place !== "acting" && !order.headset_off) {
    return { kind: "boundary", problem: now.boundary };
  }
  return betweenPhases(now, order);
}

/** Whether the clock of a phase has not started yet. */
const isBefore = (phase: Situation["phase"]): boolean =>
  phase === "to_start" || phase === "preparing";

function inPhase(now: Situation, phase: NonNullable<Situation["phase"]>): Wanted {
  switch (phase) {
    case "paused":
      return now.order?.called === true
        ? { kind: "pause", pause: { by: "participant", call: "told" } }
        : { kind: "pause", pause: { by: "operator" } };
    case "to_start":
      return { kind: "to_start" };
    case "preparing":
      return { kind: "preparing", secondsLeft: now.secondsLeft };
    case "walk_back":
      return { kind: "screen_text", text: "walk_back" };
    case "frozen":
      return { kind: "screen_text", text: "freeze" };
    case "running":
      return NOTHING;
  }
}

function betweenPhases(now: Situation, order: PanelOrder): Wanted {
  const { place, stepKind, stepIndex } = now;
  if (order.held) return { kind: "waiting" };
  if (order.form !== null) return { kind: "form", form: order.form };
  if (order.answer === "oral") return { kind: "aloud" };
  if (order.headset_off) return { kind: "take_off", isForm: order.answer === "tablet" };
  if (order.acknowledge && order.text !== null && stepIndex !== null) {
    return { kind: "reading", stepIndex, text: order.text };
  }
  if (place === "stepping_in") return { kind: "stepping_in" };
  // Whoever is in the body, and has nothing to read or to answer, waits for the next phase.
  if (stepKind !== null && place === "acting") {
    const isRefused = order.limb === "foot" && !now.areFeetTracked;
    return { kind: isRefused ? "feet" : "ready" };
  }
  return stepKind === null ? { kind: "standby" } : { kind: "waiting" };
}
