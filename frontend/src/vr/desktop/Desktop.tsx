/** The study on a screen instead of in a headset, with the keys that move the participant. */
import { Loader } from "@mantine/core";
import { number } from "@shared/format";
import { type JSX, lazy, Suspense, useEffect, useRef, useState } from "react";
import { useTexts } from "../i18n";
import { DESKTOP_KEYS } from "../tracking";
import classes from "./Desktop.module.css";

// With all names of steps and commands, which only a page on a screen needs.
const OperatorBar = lazy(() => import("./OperatorBar"));

/** Whether the page was opened for a screen: `/vr?screen=desktop`. */
export const isDesktopAddress = (): boolean =>
  new URLSearchParams(window.location.search).get("screen") === "desktop";

/** Stay on this screen after a reload, as if the page had been opened for it. */
export function keepDesktopAddress(): void {
  const address = new URL(window.location.href);
  address.searchParams.set("screen", "desktop");
  window.history.replaceState(null, "", address);
}

interface DesktopProps {
  readonly sessionId: string;
  readonly visit: {
    readonly isReady: boolean;
    readonly problem: string | null;
    /** The pictures a second, where they are too few for the session's clock; else null. */
    readonly slowHz: number | null;
    /** Nothing happens before somebody goes on in the console. */
    readonly isWaiting: boolean;
    readonly showOnScreen: (host: HTMLElement) => () => void;
  };
}

export function Desktop({ sessionId, visit }: DesktopProps): JSX.Element {
  const { t } = useTexts();
  const host = useRef<HTMLDivElement>(null);
  const { isReady, problem, showOnScreen } = visit;
  useEffect(() => {
    if (!isReady || host.current === null) return undefined;
    return showOnScreen(host.current);
  }, [isReady, showOnScreen]);
  return (
    <div className={classes.page}>
      <div ref={host} className={classes.host} data-testid="desktop" />
      {!isReady && (
        <output className={classes.waiting}>
          <Loader size="sm" /> {t("desktop.starting")}
        </output>
      )}
      {problem !== null && (
        <p className={classes.waiting} role="alert">
          {problem}
        </p>
      )}
      {visit.slowHz !== null && <TooSlow rateHz={visit.slowHz} />}
      <div className={classes.foot}>
        <Suspense fallback={null}>
          <OperatorBar sessionId={sessionId} isWaiting={visit.isWaiting} />
        </Suspense>
        <Help />
      </div>
    </div>
  );
}

/** Pictures a second below which the session's clock stands still. */
const LEAST_RATE_HZ = 2;

function TooSlow({ rateHz }: { readonly rateHz: number }): JSX.Element {
  const { t, language } = useTexts();
  const values = { rate: number(rateHz, language, 1), least: LEAST_RATE_HZ };
  return (
    <div className={classes.slow} role="alert">
      <strong>{t("desktop.slow.title", values)}</strong> {t("desktop.slow.body", values)}
    </div>
  );
}

function Help(): JSX.Element {
  const { t } = useTexts();
  const [isShown, setShown] = useState(true);
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (DESKTOP_KEYS[event.code] === "help" && !event.repeat) setShown((shown) => !shown);
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  }, []);
  const rows = [
    [t("desktop.mouse"), t("desktop.look")],
    [t("desktop.rightButton"), t("desktop.reach")],
    [t("desktop.wheel"), t("desktop.depth")],
    [t("desktop.leftButton"), t("desktop.select")],
    ["W A S D", t("desktop.walk")],
    ["Q E", t("desktop.feet")],
    [t("desktop.space"), t("desktop.grips")],
    ["X", t("desktop.hand")],
    ["C", t("desktop.squat")],
    ["T", t("desktop.tPose")],
    ["H", t("desktop.help")],
  ];
  if (!isShown) {
    return (
      <aside className={classes.hidden} aria-label={t("desktop.title")}>
        <kbd>H</kbd>
      </aside>
    );
  }
  return (
    <aside className={classes.help} aria-label={t("desktop.title")}>
      <p>
        {t("desktop.begin")} {t("desktop.hit")}
      </p>
      <dl>
        {rows.map(([key, what]) => (
          <div key={key}>
            <dt>{key}</dt>
            <dd>{what}</dd>
          </div>
        ))}
      </dl>
    </aside>
  );
}
