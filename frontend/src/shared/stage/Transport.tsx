/** The controls of a movement: play, step, speed, loop, and a scrubber with its gaps beneath. */
import { ActionIcon, SegmentedControl, Switch, Tooltip } from "@mantine/core";
import { type JSX, useEffect, useMemo } from "react";
import { Icon } from "../ui/Icon";
import { drawnEvery, durationOf, frameAt, type PointMotion, recordedFrame, timeOf } from "./motion";
import { gapStretches, unseenNames } from "./placing";
import classes from "./Transport.module.css";
import { type Playback, SPEEDS } from "./usePlayback";

export interface TransportTexts {
  readonly play: string;
  readonly pause: string;
  /** `every`: recorded frames from one drawn frame to the next. */
  readonly stepBack: (every: number) => string;
  readonly stepOn: (every: number) => string;
  readonly scrubber: string;
  readonly speed: string;
  readonly loop: string;
  /** `1.25 s of 2.85 s`. */
  readonly time: (time: number, duration: number) => string;
  readonly frame: (frame: number, last: number, every: number) => string;
  /** The accessible label of the strip of gaps. */
  readonly gaps: string;
  readonly unseen: (names: readonly string[]) => string;
}

interface TransportProps {
  readonly motion: PointMotion;
  readonly playback: Playback;
  readonly texts: TransportTexts;
}

export function Transport({ motion, playback, texts }: TransportProps): JSX.Element {
  const frame = frameAt(motion, playback.time);
  const last = motion.frames - 1;
  const every = drawnEvery(motion);
  const go = (to: number) => playback.seek(timeOf(motion, Math.min(Math.max(to, 0), last)));
  useTransportKeys({ toggle: playback.toggle, step: (by) => go(frame + by) });
  const words = `${texts.time(playback.time, durationOf(motion))}, ${texts.frame(
    recordedFrame(motion, frame),
    recordedFrame(motion, last),
    every,
  )}`;
  return (
    <div className={classes.transport}>
      <div className={classes.track}>
        <input
          type="range"
          aria-label={texts.scrubber}
          aria-valuetext={words}
          min={0}
          max={last}
          step={1}
          value={frame}
          onChange={(event) => go(Number(event.currentTarget.value))}
        />
        <GapStrip motion={motion} label={texts.gaps} />
      </div>
      <div className={classes.row}>
        <Press icon="back" name={texts.stepBack(every)} onClick={() => go(frame - 1)} />
        <Press
          icon={playback.playing ? "pause" : "play"}
          name={playback.playing ? texts.pause : texts.play}
          filled
          onClick={playback.toggle}
        />
        <Press icon="forward" name={texts.stepOn(every)} onClick={() => go(frame + 1)} />
        <span className={`${classes.playhead} numbers`} data-frame={recordedFrame(motion, frame)}>
          {texts.time(playback.time, durationOf(motion))}
          <span className={classes.frame}>
            {" · "}
            {texts.frame(recordedFrame(motion, frame), recordedFrame(motion, last), every)}
          </span>
        </span>
        <SegmentedControl
          size="xs"
          aria-label={texts.speed}
          value={String(playback.speed)}
          onChange={(value) => playback.setSpeed(Number(value))}
          data={SPEEDS.map((speed) => ({ value: String(speed), label: `${speed}×` }))}
        />
        <Switch
          size="sm"
          label={texts.loop}
          checked={playback.loop}
          onChange={(event) => playback.setLoop(event.currentTarget.checked)}
        />
      </div>
      <Unseen motion={motion} frame={frame} texts={texts} />
    </div>
  );
}

/** The more points are missing, the higher the mark: it does not depend on colour. */
function GapStrip({
  motion,
  label,
}: {
  readonly motion: PointMotion;
  readonly label: string;
}): JSX.Element | null {
  const stretches = useMemo(() => gapStretches(motion), [motion]);
  if (stretches.length === 0) return null;
  return (
    <svg
      className={classes.gaps}
      role="img"
      aria-label={label}
      viewBox={`0 0 ${motion.frames} 1`}
      preserveAspectRatio="none"
    >
      {stretches.map(({ from, to, share }) => {
        const height = 0.3 + 0.7 * share;
        return (
          <rect
            key={from}
            x={from}
            width={to - from}
            y={1 - height}
            height={height}
            fill="var(--warn-line)"
          />
        );
      })}
    </svg>
  );
}

/** Always one line high if there are gaps, so that nothing jumps during playback. */
function Unseen({
  motion,
  frame,
  texts,
}: {
  readonly motion: PointMotion;
  readonly frame: number;
  readonly texts: TransportTexts;
}): JSX.Element | null {
  const gaps = useMemo(() => gapStretches(motion).length > 0, [motion]);
  if (!gaps) return null;
  return (
    <span className={classes.gapWords}>
      <span className={classes.swatch} aria-hidden="true" />
      {texts.unseen(unseenNames(motion, frame))}
    </span>
  );
}

interface Keys {
  readonly toggle: () => void;
  readonly step: (by: number) => void;
}

/** Space and arrows work anywhere on the page unless the focused element uses them. */
function useTransportKeys({ toggle, step }: Keys): void {
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.altKey || event.ctrlKey || event.metaKey) return;
      const target = event.target instanceof Element ? event.target : document.body;
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (event.key === " " && target.closest(TAKES_SPACE) === null) toggle();
      else if (by !== undefined && target.closest(TAKES_ARROWS) === null) {
        step(by * (event.shiftKey ? 10 : 1));
      } else return;
      event.preventDefault();
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  });
}

const TYPED = 'textarea, select, [contenteditable="true"], [role="dialog"], [role="combobox"]';
const TAKES_SPACE = `input:not([type="range"]), button, a, summary, [role="option"], ${TYPED}`;
const TAKES_ARROWS = `input, [role="tab"], [role="radio"], [role="option"], ${TYPED}`;

interface PressProps {
  readonly icon: "back" | "forward" | "play" | "pause";
  readonly name: string;
  readonly filled?: boolean;
  readonly onClick: () => void;
}

/** A button of a transport: an icon with its name as a tooltip. */
export function Press({ icon, name, filled = false, onClick }: PressProps): JSX.Element {
  return (
    <Tooltip label={name}>
      <ActionIcon
        size="lg"
        variant={filled ? "filled" : "default"}
        aria-label={name}
        onClick={onClick}
      >
        <Icon name={icon} size={18} />
      </ActionIcon>
    </Tooltip>
  );
}
