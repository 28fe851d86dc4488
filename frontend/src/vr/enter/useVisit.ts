/** The session that this headset takes part in: its connection, and whether VR is shown. */
import { useCallback, useEffect, useRef, useState } from "react";
import { listenTo } from "../desktop/input";
import type { Vr } from "../session";
import {
  type Failure,
  openTelemetryInWorker,
  type Status,
  type TelemetryClient,
  TelemetryError,
  type Welcome,
} from "../telemetry";
import { DesktopSource } from "../tracking";
import type { Pairing } from "./pairing";

/** `left`: VR was shown and is not any more. */
export type VrState = "not_yet" | "entering" | "shown" | "left";

export interface VisitState {
  readonly welcome: Welcome | null;
  readonly isReady: boolean;
  readonly isConnected: boolean;
  readonly isOver: boolean;
  /** Why the connection has ended for good. */
  readonly failure: Failure | null;
  readonly vr: VrState;
  /** Why VR could not be shown. */
  readonly problem: string | null;
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
  const [vrState, setVrState] = useState<VrState>("not_yet");
  const [problem, setProblem] = useState<string | null>(null);
  const vr = useRef<Vr | null>(null);
  const fail = useCallback((error: unknown) => {
    if (error instanceof TelemetryError) setFailure(error.failure);
    else setProblem(error instanceof Error ? error.message : String(error));
  }, []);

  useEffect(() => {
    const leaving = new AbortController();
    const { signal } = leaving;
    let client: TelemetryClient | null = null;
    const open = async () => {
      client = await openTelemetryInWorker(optionsFor(pairing), { onStatus: setStatus, signal });
      if (signal.aborted) return client.close();
      client.onState(({ status }) => setOver(OVER.has(status)));
      setOver(OVER.has(client.state.status));
      // The code of VR is fetched before the button can be pressed: a click's permission to enter
      // VR lasts for seconds only.
      const { Vr } = await import("../session");
      vr.current = new Vr({
        telemetry: client,
        token: pairing.token,
        withFingers: false,
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
      vr.current?.showOnScreen(host, source);
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
    failure: status?.failure ?? failure,
    vr: vrState,
    problem,
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
    abilities: { avatars: ["delayed_copy", "physics"], changesAvatar: true, goals: true },
  };
}
