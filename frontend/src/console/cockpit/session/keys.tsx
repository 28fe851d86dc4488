/** The cockpit's keys. They are inactive while a dialog is open or something is being typed. */
import type { JSX } from "react";
import { useEffect, useRef } from "react";
import { useTexts } from "../../i18n";
import { type KeyboardHelpProps, KeyList } from "../../ui/Key";

export interface Keys {
  readonly primary: () => void;
  readonly pause: () => void;
  readonly redo: () => void;
  readonly skip: () => void;
  readonly note: () => void;
  readonly log: () => void;
  readonly help: () => void;
  readonly alarms: () => void;
  readonly checks: () => void;
  readonly avatar: () => void;
  /** Changes whenever the primary action changes its meaning. */
  readonly step: string;
}

/**
 * After a step has changed, a key that is held or hit twice must not trigger the next step's
 * action.
 */
const ARM_AFTER_MS = 700;

const BINDINGS: Readonly<Record<string, Exclude<keyof Keys, "step">>> = {
  Enter: "primary",
  " ": "primary",
  p: "pause",
  r: "redo",
  s: "skip",
  n: "note",
  l: "log",
  a: "alarms",
  c: "checks",
  b: "avatar",
  "?": "help",
};

export function useKeys(keys: Keys): void {
  const latest = useRef(keys);
  const changedAt = useRef(0);
  useEffect(() => {
    latest.current = keys;
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: the time is that of the step's change
  useEffect(() => {
    changedAt.current = performance.now();
  }, [keys.step]);
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const binding = BINDINGS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (binding === undefined || event.repeat || isBusy(event)) return;
      const waited = performance.now() - changedAt.current;
      if (binding === "primary" && (isControl(event.target) || waited < ARM_AFTER_MS)) return;
      event.preventDefault();
      latest.current[binding]();
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, []);
}

/** Whether something is being typed, a dialog is open, or the key belongs to the browser. */
export function isBusy(event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return true;
  const target = event.target as HTMLElement;
  if (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName)) return true;
  return document.querySelector('[role="dialog"], [role="menu"]') !== null;
}

/** Whether Enter already activates the focused button or link. */
const isControl = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement &&
  target.closest("button, a, [role=button], [tabindex='0']") !== null;

/** The list of all keys of the cockpit. */
export function KeyboardHelp(props: KeyboardHelpProps): JSX.Element {
  const { t } = useTexts();
  const keys = [
    [[t("keys.enterOrSpace")], t("keys.primary")],
    [["T"], t("device.pair.tablet")],
    [["H"], t("device.pair.headset")],
    [["P"], t("keys.pause")],
    [["N"], t("keys.note")],
    [["R"], t("keys.redo")],
    [["S"], t("keys.skip")],
    [["L"], t("keys.log")],
    [["A"], t("alarm.open")],
    [["C"], t("preflight.open")],
    [["B"], t("avatarChanges.key")],
    [["1 2 3"], t("live3d.keys")],
    [["?"], t("keys.help")],
    [["Esc"], t("keys.close")],
  ] as const;
  return <KeyList {...props} keys={keys} />;
}
