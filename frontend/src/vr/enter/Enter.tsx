/**
 * The page before VR: pairing, the connection, what stands in the way of VR, and the button.
 *
 * Everything after the button follows from the session's state; nobody has to come back here unless
 * the headset was put down or its browser ended VR.
 */
import { Button, Loader, SegmentedControl, Title } from "@mantine/core";
import { ApiError, Unreachable } from "@shared/api/request";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { codeFromAddress, writtenCode } from "@shared/pairingCode";
import { UnloadedNotice } from "@shared/ui/Boundary";
import { CodeEntry } from "@shared/ui/CodeEntry";
import { Mark } from "@shared/ui/Mark";
import { ErrorNotice, errorTexts, Notice } from "@shared/ui/Notice";
import { useMutation } from "@tanstack/react-query";
import { type JSX, type ReactNode, useCallback, useEffect, useRef, useState } from "react";
import { Desktop, isDesktopAddress, keepDesktopAddress } from "../desktop/Desktop";
import { useTexts } from "../i18n";
import { givenName } from "../selftest/givenName";
import classes from "./Enter.module.css";
import { NameField } from "./NameField";
import { forgetPairing, type Pairing, pair, storedPairing, storePairing } from "./pairing";
import { SelfTestOffer, SelfTestOnScreen, SelfTestResult } from "./selftest/SelfTest";
import { useSelfTest } from "./selftest/useSelfTest";
import { deviceOf, type Support, supportOf } from "./support";
import { useVisit, type VisitState } from "./useVisit";

export function Enter(): JSX.Element {
  const [pairing, setPairing] = useState(storedPairing);
  const [isDisconnected, setDisconnected] = useState(false);
  const pairingByCode = usePairing((made) => {
    storePairing(made);
    setDisconnected(false);
    setPairing(made);
  });
  useCodeOfAddress(pairingByCode.mutate);
  if (pairing === null || pairingByCode.isPending || pairingByCode.isError) {
    return <PairingPage pairing={pairingByCode} isDisconnected={isDisconnected} />;
  }
  return (
    <VisitPage
      key={pairing.token}
      pairing={pairing}
      onCode={pairingByCode.mutate}
      onUnpaired={(isRefused) => {
        forgetPairing(isRefused);
        setDisconnected(isRefused);
        setPairing(null);
      }}
    />
  );
}

interface FrameProps {
  readonly isSimulated?: boolean;
  readonly children: ReactNode;
}

function Frame({ isSimulated = false, children }: FrameProps): JSX.Element {
  const { t, language, setLanguage } = useTexts();
  return (
    <div className={classes.page}>
      <header className={classes.bar}>
        <Mark size={24} />
        {isSimulated && <span className={classes.simulated}>{t("enter.simulated")}</span>}
        <div className={classes.tools}>
          <SegmentedControl
            size="md"
            aria-label={t("enter.language")}
            data={Object.entries(LANGUAGE_NAMES).map(([value, label]) => ({ value, label }))}
            value={language}
            onChange={(next) => setLanguage(next === "de" ? "de" : "en")}
          />
        </div>
      </header>
      <main className={classes.content}>{children}</main>
    </div>
  );
}

// Pairing.

function usePairing(onPaired: (pairing: Pairing) => void) {
  const { t } = useTexts();
  return useMutation({
    mutationFn: async (code: string) => {
      try {
        return await pair(code, givenName() || deviceOf(navigator.userAgent));
      } catch (error) {
        if (!(error instanceof ApiError) || error.code !== "wrong_device") throw error;
        const said = { message: t("pair.tablet"), remedy: t("pair.tabletRemedy") };
        throw new ApiError(error.status, { code: error.code, ...said });
      }
    },
    onSuccess: onPaired,
  });
}

/**
 * Use the pairing code of a link or QR code once, and remove it from the address. Opened again in the
 * browser that it has paired, the link changes nothing.
 */
function useCodeOfAddress(use: (code: string) => void): void {
  const isUsed = useRef(false);
  useEffect(() => {
    if (isUsed.current) return;
    isUsed.current = true;
    const { code, rest } = codeFromAddress(new URL(window.location.href));
    if (code === null) return;
    window.history.replaceState(null, "", rest);
    // The link that has paired this browser was opened again, such as by its QR code.
    if (code !== storedPairing()?.code) use(code);
  }, [use]);
}

interface PairingPageProps {
  readonly pairing: ReturnType<typeof usePairing>;
  readonly isDisconnected: boolean;
}

function PairingPage({ pairing, isDisconnected }: PairingPageProps): JSX.Element {
  const { t } = useTexts();
  const support = useSupport();
  const [characters, setCharacters] = useState("");
  const { isPending, isSuccess, variables, error } = pairing;
  const send = (code: string) => {
    // The sixth character sends the code, and so does Enter.
    const isSent = isPending || (isSuccess && variables === code);
    if (!isSent) pairing.mutate(code);
  };
  return (
    <Frame>
      <div>
        <Title order={1}>{t("pair.title")}</Title>
        <p className={classes.lead}>{t("pair.lead")}</p>
      </div>
      <div className={classes.state}>
        {error !== null && (
          <Failure
            error={error}
            // A rejected code stays rejected: there is nothing to retry.
            {...(error instanceof Unreachable && { onRetry: () => send(writtenCode(characters)) })}
          />
        )}
        {isDisconnected && error === null && !isPending && (
          <Notice tone="warn" title={t("pair.ended.title")}>
            {t("pair.ended.body")}
          </Notice>
        )}
      </div>
      <CodeEntry
        characters={characters}
        disabled={isPending}
        label={t("pair.code")}
        deleteLabel={t("pair.delete")}
        onCharacters={setCharacters}
        onCode={send}
      />
      {isPending && <Waiting text={t("pair.connecting")} />}
      <NameField />
      <div className={classes.state}>
        <SupportNotice support={support} />
      </div>
    </Frame>
  );
}

// The visit.

interface VisitPageProps {
  readonly pairing: Pairing;
  /** The code of the next session was entered. */
  readonly onCode: (code: string) => void;
  /** `isRefused`: the server no longer knows this headset; else somebody asked for another code. */
  readonly onUnpaired: (isRefused: boolean) => void;
}

/** Failures of the connection after which only another pairing helps. */
const UNPAIRED = new Set([
  "closed_4401",
  "not_signed_in",
  // The socket cannot even be opened: the address is this page's own, so it is the token.
  "address",
]);

function VisitPage({ pairing, onCode, onUnpaired }: VisitPageProps): JSX.Element {
  const { t, language, setLanguage } = useTexts();
  const support = useSupport();
  const visit = useVisit(pairing);
  const test = useSelfTest(pairing, visit, language);
  const [isTestOnScreen, setTestOnScreen] = useState(false);
  const endTestOnScreen = useCallback(() => setTestOnScreen(false), []);
  const [isOnScreen, setOnScreen] = useState(isDesktopAddress);
  const { failure, welcome } = visit;
  const isUnpaired = failure !== null && UNPAIRED.has(failure.code);
  useEffect(() => {
    if (isUnpaired) onUnpaired(true);
  }, [isUnpaired, onUnpaired]);
  const spoken = welcome === null ? null : welcome.language === "de" ? "de" : "en";
  // Once, when the session says so; the participant may still choose the other one.
  const isSpoken = useRef(false);
  useEffect(() => {
    if (spoken === null || isSpoken.current) return;
    isSpoken.current = true;
    if (spoken !== language) setLanguage(spoken);
  }, [spoken, language, setLanguage]);
  if (isOnScreen && !visit.isOver && failure === null) {
    return <Desktop sessionId={pairing.sessionId} visit={visit} />;
  }
  if (isTestOnScreen) return <SelfTestOnScreen test={test} onEnd={endTestOnScreen} />;
  if (test.progress !== null) {
    return (
      <Frame>
        <SelfTestResult test={test} />
      </Frame>
    );
  }
  return (
    <Frame isSimulated={welcome !== null && welcome.time_scale !== 1}>
      <div>
        <Title order={1}>{visit.isOver ? t("enter.over") : t("enter.title")}</Title>
        <p className={classes.lead}>{visit.isOver ? t("enter.overBody") : t("enter.lead")}</p>
      </div>
      {(visit.isOver || failure?.code === "withdrawn") && <NextCode onCode={onCode} />}
      {!visit.isOver && (
        <Button
          className={classes.enter ?? ""}
          disabled={support !== "ready" || !visit.isReady}
          loading={visit.vr === "entering"}
          onClick={visit.enter}
        >
          {t(visit.vr === "left" ? "enter.again" : "enter.button")}
        </Button>
      )}
      {!visit.isOver && isForScreens(support) && (
        <Button
          size="lg"
          variant="light"
          disabled={!visit.isReady}
          onClick={() => {
            keepDesktopAddress();
            setOnScreen(true);
          }}
        >
          {t("enter.onScreen")}
        </Button>
      )}
      <SelfTestOffer
        test={test}
        hasVr={support === "ready"}
        onScreen={() => setTestOnScreen(true)}
      />
      <NameField />
      <div className={classes.state}>
        <VisitNotices visit={visit} />
        <SupportNotice support={support} />
        {!visit.isReady && failure?.code !== "journal_in_use" && (
          <Button variant="subtle" onClick={() => onUnpaired(false)}>
            {t("enter.disconnect")}
          </Button>
        )}
      </div>
    </Frame>
  );
}

/** After the end: the code of the next session, without a way around. */
function NextCode({ onCode }: { readonly onCode: (code: string) => void }): JSX.Element {
  const { t } = useTexts();
  const [characters, setCharacters] = useState("");
  return (
    <section className={classes.next} aria-label={t("enter.next")}>
      <p className={classes.lead}>{t("enter.next")}</p>
      <CodeEntry
        characters={characters}
        disabled={false}
        label={t("pair.code")}
        deleteLabel={t("pair.delete")}
        onCharacters={setCharacters}
        onCode={onCode}
      />
    </section>
  );
}

/** Failures that people meet, told in the page's language; all others in the server's words. */
const IN_OWN_WORDS = new Set(["foreign_journal", "withdrawn", "journal_in_use", "taken_over"]);

function VisitNotices({ visit }: { readonly visit: VisitState }): JSX.Element {
  const { t } = useTexts();
  const { failure, problem, isReady, isConnected, vr, isOver, isUnloaded } = visit;
  return (
    <>
      {failure?.code === "foreign_journal" && (
        <Notice tone="bad" title={t("enter.foreign")} remedy={t("enter.foreign.remedy")} />
      )}
      {failure?.code === "withdrawn" && <Notice tone="info">{t("enter.withdrawn")}</Notice>}
      {failure?.code === "journal_in_use" && (
        <Notice tone="warn" title={t("enter.inUse")} remedy={t("enter.inUse.remedy")} />
      )}
      {failure?.code === "taken_over" && (
        <Notice tone="warn" title={t("enter.takenOver")} remedy={t("enter.takenOver.remedy")} />
      )}
      {failure !== null && !IN_OWN_WORDS.has(failure.code) && (
        <Notice tone="bad" title={t("enter.stopped")} remedy={failure.remedy}>
          {failure.message}
        </Notice>
      )}
      {problem !== null && (
        <Notice tone="bad" title={t("enter.failed")}>
          {problem}
        </Notice>
      )}
      {isUnloaded && <UnloadedNotice />}
      {failure === null && !isReady && !isUnloaded && <Waiting text={t("enter.connecting")} />}
      {failure === null && isReady && !isConnected && (
        <Notice tone="warn">{t("enter.offline")}</Notice>
      )}
      {vr === "left" && !isOver && <Notice tone="info">{t("enter.ended")}</Notice>}
    </>
  );
}

// What both have.

/** Asks the browser whether VR is possible, again when a headset is switched on. */
function useSupport(): Support | null {
  const [support, setSupport] = useState<Support | null>(null);
  useEffect(() => {
    const look = () => void supportOf(globalThis).then(setSupport);
    look();
    const { xr } = navigator;
    xr?.addEventListener?.("devicechange", look);
    return () => xr?.removeEventListener?.("devicechange", look);
  }, []);
  return support;
}

/** Whether this is a computer without VR, on which mouse and keyboard can take its place. */
const isForScreens = (support: Support | null): boolean =>
  (support === "no_webxr" || support === "no_headset") &&
  deviceOf(navigator.userAgent) === "computer";

function SupportNotice({ support }: { readonly support: Support | null }): JSX.Element | null {
  const { t } = useTexts();
  if (support === null || support === "ready") return null;
  const device = deviceOf(navigator.userAgent);
  return (
    <Notice tone="warn" title={t(`support.${support}`)}>
      {t(`support.${support}.${device}`)}
    </Notice>
  );
}

function Waiting({ text }: { readonly text: string }): JSX.Element {
  return (
    <Button variant="transparent" fullWidth leftSection={<Loader size="sm" />}>
      {text}
    </Button>
  );
}

interface FailureProps {
  readonly error: unknown;
  readonly onRetry?: () => void;
}

function Failure({ error, onRetry }: FailureProps): JSX.Element {
  const { t } = useTexts();
  return <ErrorNotice error={error} texts={errorTexts(t)} onRetry={onRetry} />;
}
