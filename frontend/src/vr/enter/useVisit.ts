/** The session that this headset takes part in: its connection, and whether VR is shown. */
import { isUnloaded } from "@shared/ui/unloaded";
import { useCallback, useEffect, useRef, useState } from "react";
import { listenTo } from "../desktop/input";
import type { Vr } from "../session";
import {
  type Failure,
  type HeadsetState,
  openTelemetryInWorker,
  type Status,
  type TelemetryClient,
  TelemetryError,
  type Welcome,
} from "../telemetry";
import { DesktopSource } from "../tracking";
import { discardForms, discardSession, sendEarlier } from "./earlier";
import { forgetPairing, type Pairing } from "./pairing";

/** `left`: VR was shown and is not any more. */
export type VrState = "not_yet" | "entering" | "shown" | "left";

export interface VisitState {
  readonly welcome: Welcome | null;
  readonly isReady: boolean;
  readonly isConnected: boolean;
  readonly isOver: boolean;
  /** Nothing of the session is under way that a test of the headset would disturb. */
  readonly isBetween: boolean;
  /** No phase runs or counts down: somebody goes on in the console, or answers a form. */
  readonly isWaiting: boolean;
  /** Why the connection has ended for good. */
  readonly failure: Failure | null;
  readonly vr: VrState;
  /** The pictures a second on this screen, where they are too few; else null. */
  readonly slowHz: number | null;
  /** Why VR could not be shown. */
  readonly problem: string | null;
  /** A part of this page could not be loaded; the page says why, and what to do. */
  readonly isUnloaded: boolean;
  /** Show VR; call it in the handler of a click, which browsers demand. */
  readonly enter: () => void;
  /** Show the study on this screen instead, moved by mouse and keyboard; returns how to end it. */
  readonly showOnScreen: (host: HTMLElement) => () => void;
}

const OVER = new Set(["completed", "aborted", "withdrawn"]);

/** The stature of somebody of whom none is known yet, m. */
const USUAL_STATURE_M = 1.72;

/** The name under which the client says hello. */
const NAME = "reembody headset page";

export function useVisit(pairing: Pairing): VisitState {
  const [telemetry, setTelemetry] = useState<TelemetryClient | null>(null);
  const [status, setStatus] = useState<Status | null>(null);
  const [failure, setFailure] = useState<Failure | null>(null);
  const [isOver, setOver] = useState(false);
  const [isBetween, setBetween] = useState(false);
  const [isWaiting, setWaiting] = useState(false);
  const [vrState, setVrState] = useState<VrState>("not_yet");
  const [problem, setProblem] = useState<string | null>(null);
  const [slowHz, setSlowHz] = useState<number | null>(null);
  const [isPartMissing, setUnloaded] = useState(false);
  const vr = useRef<Vr | null>(null);
  const fail = useCallback((error: unknown) => {
    if (isUnloaded(error)) setUnloaded(true);
    else if (error instanceof TelemetryError) setFailure(error.failure);
    else setProblem(error instanceof Error ? error.message : String(error));
  }, []);

  const isWithdrawn = (status?.failure ?? failure)?.code === "withdrawn";
  useEffect(() => {
    if (!isWithdrawn) return;
    setOver(true);
    forgetPairing(true);
    const discard = async () => {
      // Closed first: a journal that is open cannot be deleted.
      await telemetry?.close();
      await discardSession(pairing.sessionId);
    };
    void discard().catch(() => undefined);
  }, [isWithdrawn, telemetry, pairing]);

  useEffect(() => {
    const leaving = new AbortController();
    const { signal } = leaving;
    let client: TelemetryClient | null = null;
    const open = async () => {
      void sendEarlier(pairing.sessionId, optionsFor).catch(() => undefined);
      client = await openTelemetryInWorker(optionsFor(pairing), { onStatus: setStatus, signal });
      if (signal.aborted) return client.close();
      const follow = (state: HeadsetState) => {
        setOver(OVER.has(state.status));
        if (state.status === "withdrawn") {
          forgetPairing(true);
          void discardForms(pairing.sessionId).catch(() => undefined);
        }
        setBetween(isBetweenSteps(state));
        setWaiting(state.phase === null || state.phase.status === "paused");
      };
      client.onState(follow);
      follow(client.state);
      // The code of VR is fetched before the button can be pressed: a click's permission to enter
      // VR lasts for seconds only.
      const { Vr } = await import("../session");
      vr.current = new Vr({
        telemetry: client,
        token: pairing.token,
        withFingers: knowsHands(),
        onEnd: () => setVrState("left"),
        onFailure: fail,
      });
      setTelemetry(client);
    };
    open().catch((error: unknown) => {
      if (!signal.aborted) fail(error);
    });
    return () => {
      leaving.abort();
      vr.current?.dispose();
      vr.current = null;
      void client?.close().catch(() => undefined);
    };
  }, [pairing, fail]);

  const enter = useCallback(() => {
    if (vr.current === null) return;
    setProblem(null);
    setVrState("entering");
    vr.current.enter().then(
      () => setVrState("shown"),
      (error: unknown) => {
        setVrState("not_yet");
        fail(error);
      },
    );
  }, [fail]);

  const showOnScreen = useCallback(
    (host: HTMLElement) => {
      const statureM = telemetry?.state.participant.stature_m ?? USUAL_STATURE_M;
      const source = new DesktopSource(statureM);
      vr.current?.showOnScreen(host, source, setSlowHz);
      setVrState("shown");
      return listenTo(host, source);
    },
    [telemetry],
  );

  return {
    welcome: telemetry?.welcome ?? null,
    isReady: telemetry !== null,
    isConnected: status?.connected ?? false,
    isOver,
    isBetween,
    isWaiting,
    failure: status?.failure ?? failure,
    vr: vrState,
    slowHz,
    problem,
    isUnloaded: isPartMissing,
    enter,
    showOnScreen,
  };
}

function optionsFor({ sessionId, token }: Pairing) {
  const { protocol, host } = window.location;
  return {
    url: `${protocol === "https:" ? "wss" : "ws"}://${host}/api/vr/stream`,
    token,
    name: NAME,
    storageKey: sessionId,
    fingers: knowsHands(),
    abilities: {
      avatars: ["delayed_copy", "physics"],
      changesAvatar: true,
      goals: true,
      panels: true,
      calibrates: true,
    },
  };
}

/** Before the step in which the body is entered, and after the end: nobody is wanted in VR. */
const isBetweenSteps = ({ status, phase, step_kind, ...state }: HeadsetState): boolean => {
  const isInBody = state.materialised || state.recording || step_kind === "materialise";
  return OVER.has(status) || (phase === null && !isInBody);
};

/**
 * Whether this browser can track hands. A run says hello before it is known whether somebody lays
 * the controllers down, so the streams of fingers are announced wherever that can happen.
 */
export const knowsHands = (): boolean => "XRHand" in globalThis;
