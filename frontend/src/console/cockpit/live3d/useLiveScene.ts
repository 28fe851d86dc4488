/**
 * The live scene on an element of the page. Poses are drawn outside of React; only what the words
 * around the picture need is state. Nothing is requested while the page is hidden.
 */
import { useComputedColorScheme } from "@mantine/core";
import { useDocumentVisibility } from "@mantine/hooks";
import { sessions } from "@shared/api/endpoints";
import type { FeedState } from "@shared/api/live";
import { openPoses, type PoseSetup, type PoseTouch } from "@shared/api/poses";
import { paletteOf } from "@shared/stage/figure";
import type { BodyMarks } from "@shared/stage/marks";
import { type DrawingState, useDrawing } from "@shared/stage/useDrawing";
import { type RefObject, useEffect, useRef, useState } from "react";
import { useDrawnAs } from "../../bodyView/DrawnAs";
import { type BodyState, useBody } from "../../bodyView/useBody";
import type { TelemetryStore } from "../session/telemetryStore";
import { DARK, type Lights, nextChange, tonesAt, withTouches } from "./lights";
import type { View } from "./views";

/** Frames come at least ten times a second: after this time without one there is no movement. */
const STILL_AFTER_MS = 1500;

export interface Live {
  readonly drawingState: DrawingState;
  readonly feed: FeedState;
  readonly setup: PoseSetup | null;
  readonly isMoving: boolean;
  readonly last: PoseTouch | null;
  readonly body: BodyState;
}

export interface Watched {
  /** The session's id. */
  readonly id: string;
  readonly store: TelemetryStore;
  readonly view: View;
  readonly marks: BodyMarks;
  /** What lies over the upper edge of the picture. */
  readonly cover: RefObject<HTMLElement | null>;
}

export function useLiveScene(
  root: RefObject<HTMLDivElement | null>,
  { id, store, view, marks, cover }: Watched,
): Live {
  const scheme = useComputedColorScheme("light");
  const isPageVisible = useDocumentVisibility() === "visible";
  const { drawingState, drawing: scene } = useDrawing(root, loadScene);
  const [feed, setFeed] = useState<FeedState>("connecting");
  const [setup, setSetup] = useState<PoseSetup | null>(null);
  const [isMoving, setMoving] = useState(false);
  const [last, setLast] = useState<PoseTouch | null>(null);
  const [drawn] = useDrawnAs();
  const body = useBody(drawn === "skin" ? (setup?.body?.hash ?? null) : null);
  const { model } = body;
  const lights = useRef<Lights>(DARK);
  const relight = useRef<() => void>(() => {});

  // Read the colours again when the colour scheme changes.
  useEffect(() => {
    if (scene === null || setup === null || root.current === null || scheme === undefined) return;
    scene.prepare(setup, paletteOf(root.current), model);
    root.current.dataset.drawn = model === null ? "skeleton" : "skin";
    relight.current();
    const heat = () => {
      const errors = setup.blinded ? undefined : store.latest()?.telemetry.joint_error_deg;
      if (errors !== undefined) scene.heat(errors);
    };
    heat();
    return store.subscribe(heat);
  }, [root, scene, setup, scheme, store, model]);

  useEffect(() => scene?.setView(view), [scene, view]);

  useEffect(() => {
    const [canvas, over] = [root.current, cover.current];
    if (scene === null || canvas === null || over === null) return;
    const measure = () => {
      const { top } = canvas.getBoundingClientRect();
      scene.cover(Math.max(0, over.getBoundingClientRect().bottom - top));
    };
    const observer = new ResizeObserver(measure);
    observer.observe(over);
    observer.observe(canvas);
    return () => observer.disconnect();
  }, [root, cover, scene]);

  // By their content: the session is a new object whenever anything in it changes.
  const marked = JSON.stringify(marks);
  useEffect(() => scene?.mark(JSON.parse(marked) as BodyMarks), [scene, marked]);

  useEffect(() => {
    if (scene === null || !isPageVisible) return;
    let heardAt = Number.NEGATIVE_INFINITY;
    let undrawn = 0;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const light = () => {
      clearTimeout(timer);
      const now = performance.now();
      const tones = tonesAt(lights.current, now);
      scene.light(tones);
      if (root.current !== null) root.current.dataset.lit = [...tones.keys()].join(" ");
      const next = nextChange(lights.current, now);
      if (next !== null) timer = setTimeout(light, next - now + 1);
    };
    relight.current = light;
    const poses = openPoses({
      url: sessions.poseUrl(id),
      onState: setFeed,
      onSetup: setSetup,
      onPose: ({ stream, values, phaseId }) => {
        heardAt = performance.now();
        undrawn++;
        setMoving(true);
        if (phaseId !== 0 && phaseId !== lights.current.phaseId) {
          lights.current = { ...DARK, seen: lights.current.seen, phaseId };
          light();
        }
        scene.show(stream, values);
      },
      onFingers: ({ stream, values }) => scene.bend(stream, values),
      onTouches: (touches) => {
        lights.current = withTouches(lights.current, touches, performance.now());
        setLast(lights.current.last);
        light();
      },
    });
    let pictures = 0;
    scene.onDrawn = () => {
      if (undrawn === 0) return;
      poses.drawn(undrawn);
      undrawn = 0;
      pictures++;
      if (root.current !== null) root.current.dataset.pictures = String(pictures);
    };
    const watch = setInterval(
      () => setMoving(performance.now() - heardAt < STILL_AFTER_MS),
      STILL_AFTER_MS / 3,
    );
    return () => {
      clearInterval(watch);
      clearTimeout(timer);
      poses.close();
      scene.onDrawn = () => {};
      relight.current = () => {};
    };
  }, [root, scene, isPageVisible, id]);

  return { drawingState, feed, setup, isMoving, last, body };
}

async function loadScene() {
  const { LiveScene } = await import("./scene");
  return (canvas: HTMLCanvasElement) => new LiveScene(canvas);
}
