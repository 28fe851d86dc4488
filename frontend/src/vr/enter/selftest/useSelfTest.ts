/** A test of this headset: whether one may begin, how far it is, and what became of its report. */
import { useCallback, useEffect, useRef, useState } from "react";
import type { SelfTest } from "../../selftest";
import { Outbox, type Refusal, sendWith, waitMs } from "../../selftest/outbox";
import type { Progress } from "../../selftest/screens";
import type { Pairing } from "../pairing";
import { knowsHands, type VisitState } from "../useVisit";

export interface SelfTestState {
  /** Whether a test may begin now. */
  readonly isPossible: boolean;
  /** The session is under way and leaves no time for one. */
  readonly isHeldBack: boolean;
  /** How far the newest test is; null before the first, or once it was put away. */
  readonly progress: Progress | null;
  /** The test is shown, in VR or on the screen. */
  readonly isShown: boolean;
  /** Why it could not begin, or why a report still waits. */
  readonly error: unknown;
  /** The session went on and ended the test. */
  readonly isOvertaken: boolean;
  /** Reports on this device that the server has not confirmed. */
  readonly waiting: number;
  /** Those among them that the server refused for good, and why. */
  readonly refused: readonly Refusal[];
  /** Begin in VR; call it in the handler of a click, which browsers demand. */
  readonly begin: () => void;
  /** Begin on the screen; returns how to end it. */
  readonly beginOn: (host: HTMLElement) => () => void;
  /** End the measurement, and then what is shown. */
  readonly stop: () => void;
  readonly close: () => void;
  readonly sendNow: () => void;
  /** Delete the refused reports from this device. */
  readonly discard: () => void;
}

export function useSelfTest(pairing: Pairing, visit: VisitState, language: string): SelfTestState {
  const { welcome, isReady, isBetween, isConnected, vr } = visit;
  const [Test, setTest] = useState<typeof SelfTest | null>(null);
  const [progress, setProgress] = useState<Progress | null>(null);
  const [isShown, setShown] = useState(false);
  const [error, setError] = useState<unknown>(null);
  const [isOvertaken, setOvertaken] = useState(false);
  const [outbox] = useState(() => new Outbox());
  const [waiting, setWaiting] = useState(outbox.reports.length);
  const [refused, setRefused] = useState<readonly Refusal[]>([]);
  /** Tries in a row after which reports still waited. */
  const [failures, setFailures] = useState(0);
  // Every state of the session comes with a welcome of its own, and begins no test anew.
  const around = useRef({ welcome, language });
  around.current = { welcome, language };
  const running = useRef<SelfTest | null>(null);
  const newestId = useRef("");

  // Before the button can be pressed: a click's permission to enter VR lasts for seconds only.
  useEffect(() => {
    if (!isReady) return;
    // The page says why this could not be loaded; the session does not need it.
    import("../../selftest")
      .then((module) => setTest(() => module.SelfTest))
      .catch(() => undefined);
  }, [isReady]);

  const deliver = useCallback(async () => {
    const sent = await outbox.deliver(sendWith(pairing.token));
    const { stored, waiting: left } = sent;
    setWaiting(left);
    setRefused(sent.refused);
    setError(sent.error);
    setFailures((before) => (left > sent.refused.length ? before + 1 : 0));
    const view = stored.find(({ id }) => id === newestId.current);
    const isWaiting = outbox.reports.some(({ id }) => id === newestId.current);
    if (view === undefined && !isWaiting) return;
    const outcome: Progress & { kind: "stored" | "kept" } =
      view === undefined ? { kind: "kept" } : { kind: "stored", view };
    running.current?.delivered(outcome);
    setProgress((now) => (now?.kind === "sending" || now?.kind === "kept" ? outcome : now));
  }, [outbox, pairing]);

  // What an earlier page could not send goes first, and again when the server is back.
  useEffect(() => {
    if (isConnected && outbox.reports.length > 0) void deliver();
  }, [isConnected, outbox, deliver]);
  useEffect(() => {
    // What the server cannot take stays so until somebody has looked at it.
    if (failures === 0) return undefined;
    const again = setTimeout(() => void deliver(), waitMs(failures - 1));
    return () => clearTimeout(again);
  }, [failures, deliver]);

  const discard = useCallback(() => {
    outbox.discard(refused.map(({ id }) => id));
    setRefused([]);
    setWaiting(outbox.reports.length);
    setError(null);
  }, [outbox, refused]);

  const dispose = useCallback(() => {
    running.current?.dispose();
    running.current = null;
    setShown(false);
  }, []);
  useEffect(() => dispose, [dispose]);

  const make = useCallback((): SelfTest | null => {
    const { welcome, language } = around.current;
    if (Test === null || welcome === null) return null;
    dispose();
    setError(null);
    setOvertaken(false);
    setProgress({ kind: "preparing", awaited: "body", waitedS: 0 });
    setShown(true);
    const test = new Test({
      token: pairing.token,
      welcome,
      language,
      withFingers: knowsHands(),
      onProgress: setProgress,
      onMeasured: (report) => outbox.keep(report),
      onReport: (report) => {
        newestId.current = report.id;
        outbox.add(report);
        void deliver();
      },
      onEnd: dispose,
    });
    running.current = test;
    return test;
  }, [Test, pairing, outbox, deliver, dispose]);

  const begin = useCallback(() => {
    make()
      ?.enter()
      .catch((reason: unknown) => {
        dispose();
        setProgress(null);
        setError(reason);
      });
  }, [make, dispose]);

  const beginOn = useCallback(
    (host: HTMLElement) => {
      make()?.showOnScreen(host);
      return dispose;
    },
    [make, dispose],
  );

  // The participant is wanted in the session: its page comes back, whatever is shown of a test.
  const isWanted = !isBetween && progress !== null;
  useEffect(() => {
    if (!isWanted) return;
    setOvertaken(running.current !== null);
    dispose();
    setProgress(null);
  }, [isWanted, dispose]);

  return {
    isHeldBack: isReady && !isBetween && !visit.isOver,
    isPossible: Test !== null && isBetween && vr !== "entering" && vr !== "shown",
    progress,
    isShown,
    error,
    isOvertaken,
    waiting,
    refused,
    discard,
    begin,
    beginOn,
    stop: useCallback(() => running.current?.stop(), []),
    close: useCallback(() => {
      dispose();
      setProgress(null);
      setError(null);
      setOvertaken(false);
    }, [dispose]),
    sendNow: useCallback(() => void deliver(), [deliver]),
  };
}
