/**
 * The try-out on an element of the page: the worker, the picture, and the loop that keeps both
 * going. Places and curves are drawn outside of React; only what the words need is state.
 */
import { useComputedColorScheme } from "@mantine/core";
import { paletteOf } from "@shared/stage/figure";
import { type DrawingState, useDrawing } from "@shared/stage/useDrawing";
import {
  type RefObject,
  useCallback,
  useEffect,
  useRef,
  useState,
  useSyncExternalStore,
} from "react";
import type { BodyToTry } from "./physics/triedBody";
import { TryoutRun } from "./run";
import type { TryoutScene } from "./scene";
import { startWorker } from "./worker/start";

export interface LiveTryout {
  readonly run: TryoutRun | null;
  readonly scene: TryoutScene | null;
  readonly drawingState: DrawingState;
  /** Why the simulation could not be started. */
  readonly error: Error | null;
  /** Call a function for every other picture, until the returned one is called. */
  readonly onPicture: (draw: () => void) => () => void;
}

export function useTryout(
  root: RefObject<HTMLDivElement | null>,
  bodies: readonly BodyToTry[] | null,
  names: readonly string[],
  axis: string,
): LiveTryout {
  const scheme = useComputedColorScheme("light");
  const { drawingState, drawing: scene } = useDrawing(root, loadScene);
  const [run, setRun] = useState<TryoutRun | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const draws = useRef(new Set<() => void>());
  const first = useRef({ bodies, axis });
  first.current = { bodies, axis };
  const sent = useRef<readonly BodyToTry[] | null>(null);
  const hasBodies = bodies !== null;

  useEffect(() => {
    if (!hasBodies) return;
    let mine: TryoutRun | null = null;
    let isGone = false;
    startWorker().then(
      ({ port, wasm }) => {
        if (isGone) return port.terminate();
        mine = new TryoutRun(port, first.current.axis);
        sent.current = first.current.bodies;
        mine.open(wasm, first.current.bodies ?? []);
        setRun(mine);
      },
      (problem: unknown) => {
        if (!isGone) setError(problem instanceof Error ? problem : new Error(String(problem)));
      },
    );
    return () => {
      isGone = true;
      mine?.dispose();
      setRun(null);
    };
  }, [hasBodies]);

  useEffect(() => {
    if (run === null || bodies === null || bodies === sent.current) return;
    sent.current = bodies;
    run.change(bodies);
  }, [run, bodies]);

  useEffect(() => run?.watch(axis), [run, axis]);

  const shapes = useSyncExternalStore(run?.subscribe ?? NEVER, () => run?.state.shapes ?? null);
  const named = names.join("\n");
  useEffect(() => {
    if (scene === null || shapes === null || root.current === null || scheme === undefined) return;
    scene.prepare(shapes, named.split("\n"), paletteOf(root.current));
    if (run !== null) scene.show(run.progress);
  }, [root, scene, run, shapes, named, scheme]);

  useEffect(() => {
    if (run === null) return;
    let request = 0;
    let pictures = 0;
    let hasNews = false;
    run.onAdvance = () => {
      hasNews = true;
      scene?.show(run.progress);
    };
    const frame = (nowMs: number) => {
      request = requestAnimationFrame(frame);
      pictures++;
      if (hasNews && pictures % 2 === 0) {
        hasNews = false;
        for (const draw of draws.current) draw();
      }
      run.frame(nowMs);
    };
    request = requestAnimationFrame(frame);
    // A hidden tab gets no pictures: time stands still, and goes on from there without a jump.
    const rest = () => run.rest();
    document.addEventListener("visibilitychange", rest);
    return () => {
      cancelAnimationFrame(request);
      document.removeEventListener("visibilitychange", rest);
      run.onAdvance = () => {};
    };
  }, [run, scene]);

  const onPicture = useCallback((draw: () => void) => {
    draws.current.add(draw);
    return () => draws.current.delete(draw);
  }, []);
  return { run, scene, drawingState, error, onPicture };
}

const NEVER = () => () => {};

async function loadScene() {
  const { TryoutScene } = await import("./scene");
  return (canvas: HTMLCanvasElement) => new TryoutScene(canvas);
}
