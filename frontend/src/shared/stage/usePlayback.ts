/** The playback of a movement: time advances with the screen's animation frames. */
import { useEffect, useRef, useState } from "react";
import { type Seconds, seconds } from "../units";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2] as const;

const FROM_THE_START = { time: seconds(0), loop: true } as const;

export interface Playback {
  readonly time: Seconds;
  readonly playing: boolean;
  readonly speed: number;
  readonly loop: boolean;
  readonly seek: (time: Seconds) => void;
  readonly toggle: () => void;
  readonly setSpeed: (speed: number) => void;
  readonly setLoop: (loop: boolean) => void;
}

export function usePlayback(
  duration: Seconds,
  begin: { readonly time: Seconds; readonly loop: boolean } = FROM_THE_START,
): Playback {
  const [time, setTime] = useState(begin.time);
  const [playing, setPlaying] = useState(false);
  const [speed, setSpeed] = useState(1);
  const [loop, setLoop] = useState(begin.loop);
  const at = useRef(time);
  const moveTo = (next: Seconds) => {
    at.current = next;
    setTime(next);
  };
  useEffect(() => {
    if (!playing || duration <= 0) return;
    let before: number | null = null;
    let frame = requestAnimationFrame(function tick(now) {
      const passed = before === null ? 0 : (now - before) / 1000;
      before = now;
      const next = advance(at.current, passed * speed, duration, loop);
      at.current = next.time;
      setTime(next.time);
      if (next.ended) setPlaying(false);
      else frame = requestAnimationFrame(tick);
    });
    return () => cancelAnimationFrame(frame);
  }, [playing, speed, loop, duration]);
  return {
    // The current movement may be shorter than the previous one.
    time: seconds(Math.min(time, duration)),
    playing,
    speed,
    loop,
    seek: (time) => moveTo(seconds(Math.min(Math.max(time, 0), duration))),
    toggle: () => {
      if (!playing && at.current >= duration) moveTo(seconds(0));
      setPlaying(!playing);
    },
    setSpeed,
    setLoop,
  };
}

/** A later time, and whether the end was reached; with `loop` it starts over. */
export function advance(
  time: Seconds,
  passed: number,
  duration: Seconds,
  loop: boolean,
): { readonly time: Seconds; readonly ended: boolean } {
  const next = time + passed;
  if (next < duration) return { time: seconds(next), ended: false };
  if (loop && duration > 0) return { time: seconds(next % duration), ended: false };
  return { time: duration, ended: true };
}
