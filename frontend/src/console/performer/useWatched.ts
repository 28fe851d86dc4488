/**
 * A performer on a body on an element of the page. Poses are drawn outside of React; only what the
 * words around the picture need is state. Nothing is requested while the page is hidden.
 */
import { useComputedColorScheme } from "@mantine/core";
import { useDocumentVisibility } from "@mantine/hooks";
import { type BodySetup, type BodyState, type BodyWish, openBody } from "@shared/api/performers";
import { paletteOf } from "@shared/stage/figure";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { type DrawingState, useDrawing } from "@shared/stage/useDrawing";
import { type RefObject, useEffect, useState } from "react";
import type { PerformerScene } from "./scene";

/** How often figures are brought up to date: people cannot read faster. */
const FIGURES_MS = 500;

/** What came in the last half second. */
export interface Figures {
  readonly drawnHz: number;
  /** Median time from a packet's arrival to its sending to this page, milliseconds. */
  readonly delayMs: number;
  /** Bones whose pose was lost or not sent. */
  readonly held: number;
}

export interface Watched {
  readonly scene: PerformerScene | null;
  readonly drawingState: DrawingState;
  readonly setup: BodySetup | null;
  /** Null before the server has told it. */
  readonly state: BodyState | null;
  readonly isLost: boolean;
  /** Null while nothing comes. */
  readonly figures: Figures | null;
}

export function useWatched(
  root: RefObject<HTMLDivElement | null>,
  wish: BodyWish,
  model: BodyModel | null,
): Watched {
  const scheme = useComputedColorScheme("light");
  const isPageVisible = useDocumentVisibility() === "visible";
  const { drawingState, drawing: scene } = useDrawing(root, loadScene);
  const [setup, setSetup] = useState<BodySetup | null>(null);
  const [state, setState] = useState<BodyState | null>(null);
  const [isLost, setLost] = useState(false);
  const [figures, setFigures] = useState<Figures | null>(null);

  // Read the colours again when the colour scheme changes.
  useEffect(() => {
    if (scene === null || setup === null || root.current === null || scheme === undefined) return;
    scene.prepare(setup, paletteOf(root.current), model);
    const hasSkin = model !== null && setup.stature_m !== null;
    root.current.dataset.drawn = hasSkin ? "skin" : "skeleton";
  }, [root, scene, setup, scheme, model]);

  const wished = JSON.stringify(wish);
  useEffect(() => {
    if (scene === null || !isPageVisible) return;
    let undrawn = 0;
    let pictures = 0;
    let held = 0;
    let delays: number[] = [];
    const feed = openBody({
      wish: JSON.parse(wished) as BodyWish,
      onSetup: setSetup,
      onState: (now) => {
        setLost(false);
        setState(now);
      },
      onPose: (pose) => {
        undrawn++;
        delays.push(pose.delayS);
        held = pose.held;
        scene.show(pose);
      },
      // What the server has said last stays: why it closed the socket.
      onLost: () => setLost(true),
    });
    scene.onDrawn = () => {
      if (undrawn === 0) return;
      feed.drawn(undrawn);
      undrawn = 0;
      pictures++;
      if (root.current !== null) root.current.dataset.pictures = String(pictures);
    };
    let before = 0;
    const timer = setInterval(() => {
      const [median] = delays.toSorted((a, b) => a - b).slice(delays.length >> 1);
      const drawnHz = ((pictures - before) * 1000) / FIGURES_MS;
      setFigures(median === undefined ? null : { drawnHz, delayMs: 1000 * median, held });
      before = pictures;
      delays = [];
    }, FIGURES_MS);
    return () => {
      clearInterval(timer);
      feed.close();
      scene.onDrawn = () => {};
      setFigures(null);
    };
  }, [root, scene, isPageVisible, wished]);

  return { scene, drawingState, setup, state, isLost, figures };
}

async function loadScene() {
  const { PerformerScene } = await import("./scene");
  return (canvas: HTMLCanvasElement) => new PerformerScene(canvas);
}
