/**
 * The keys of a replay. They are inactive while a dialog is open or something is being typed or
 * selected.
 */
import type { JSX } from "react";
import { useEffect, useRef } from "react";
import { useTexts } from "../i18n";
import { type KeyboardHelpProps, KeyList } from "../ui/Key";
import classes from "./Replay.module.css";

export const SPEEDS = [0.25, 0.5, 1, 2, 4] as const;

type Direction = -1 | 1;

export interface Keys {
  readonly toggle: () => void;
  readonly by: (seconds: number) => void;
  readonly frame: (frames: Direction) => void;
  readonly jump: (direction: Direction) => void;
  readonly end: (direction: Direction) => void;
  readonly camera: () => void;
  readonly speed: (direction: Direction) => void;
  readonly help: () => void;
}

const BINDINGS: Readonly<Record<string, (keys: Keys, more: boolean) => void>> = {
  " ": (keys) => keys.toggle(),
  k: (keys) => keys.toggle(),
  ArrowLeft: (keys, more) => keys.by(more ? -10 : -1),
  ArrowRight: (keys, more) => keys.by(more ? 10 : 1),
  ",": (keys) => keys.frame(-1),
  ".": (keys) => keys.frame(1),
  j: (keys) => keys.jump(-1),
  l: (keys) => keys.jump(1),
  "[": (keys) => keys.jump(-1),
  "]": (keys) => keys.jump(1),
  Home: (keys) => keys.end(-1),
  End: (keys) => keys.end(1),
  c: (keys) => keys.camera(),
  "-": (keys) => keys.speed(-1),
  "+": (keys) => keys.speed(1),
  "?": (keys) => keys.help(),
};

export function useReplayKeys(keys: Keys): void {
  const latest = useRef(keys);
  useEffect(() => {
    latest.current = keys;
  });
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const act = BINDINGS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (act === undefined || isBusy(event)) return;
      event.preventDefault();
      act(latest.current, event.shiftKey);
    };
    // Some browsers press a button when the space bar is released.
    const onUp = (event: KeyboardEvent) => {
      if (event.key === " " && !isBusy(event)) event.preventDefault();
    };
    document.addEventListener("keydown", onKey);
    document.addEventListener("keyup", onUp);
    return () => {
      document.removeEventListener("keydown", onKey);
      document.removeEventListener("keyup", onUp);
    };
  }, []);
}

const TYPED = 'textarea, select, [contenteditable="true"], [role="combobox"], [role="listbox"]';
/** Elements in which a key already has a meaning. An event of the list is selected with Enter. */
const TAKES: Readonly<Record<string, string>> = {
  " ": `input:not([type="range"]), button:not([data-moment]), a, summary, ${TYPED}`,
  ArrowLeft: `input:not([type="range"]), [role="tab"], [role="radio"], ${TYPED}`,
  ArrowRight: `input:not([type="range"]), [role="tab"], [role="radio"], ${TYPED}`,
};
const TAKES_LETTERS = `input:not([type="range"], [type="radio"], [type="checkbox"]), ${TYPED}`;

function isBusy(event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return true;
  if (document.querySelector('[role="dialog"], [role="menu"]') !== null) return true;
  const target = event.target instanceof Element ? event.target : document.body;
  return target.closest(TAKES[event.key] ?? TAKES_LETTERS) !== null;
}

/** The list of all keys of the replay. */
export function ReplayKeys(props: KeyboardHelpProps): JSX.Element {
  const { t } = useTexts();
  const keys = [
    [[t("replay.key.space"), "K"], t("replay.keys.play")],
    [["←", "→"], t("replay.keys.second")],
    [[",", "."], t("replay.keys.frame")],
    [["J", "L", "[", "]"], t("replay.keys.event")],
    [["Home", "End"], t("replay.keys.ends")],
    [["−", "+"], t("replay.keys.speed")],
    [["C"], t("replay.keys.camera")],
    [["?"], t("keys.help")],
  ] as const;
  return <KeyList {...props} keys={keys} namesClass={classes.keyNames} />;
}
