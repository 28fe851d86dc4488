/** A 3-D drawing on a canvas of its own, as large as its parent element. */
import { type RefObject, useEffect, useState } from "react";

interface Drawing {
  resize(width: number, height: number): void;
  dispose(): void;
}

/**
 * `flat` if the browser has no WebGL or refuses a context, `unloaded` if the code could not be
 * loaded, of which the page says why.
 */
export type DrawingState = "loading" | "space" | "flat" | "unloaded";

/**
 * Draw on an element while it is on the page. `load` imports three.js and the drawing code, and
 * must be the same function at every call.
 */
export function useDrawing<T extends Drawing>(
  root: RefObject<HTMLElement | null>,
  load: () => Promise<(canvas: HTMLCanvasElement) => T>,
): { readonly drawingState: DrawingState; readonly drawing: T | null } {
  const [drawingState, setWay] = useState<DrawingState>("loading");
  const [drawing, setDrawing] = useState<T | null>(null);
  useEffect(() => {
    const element = root.current;
    if (element === null) return;
    let cancelled = false;
    let tidy = () => {};
    void load().then(
      (make) => {
        if (cancelled) return;
        const mounted = mount(element, make);
        if (mounted === null) return setWay("flat");
        tidy = mounted.tidy;
        setDrawing(mounted.drawing);
        setWay("space");
      },
      () => {
        if (!cancelled) setWay("unloaded");
      },
    );
    return () => {
      cancelled = true;
      setDrawing(null);
      setWay("loading");
      tidy();
    };
  }, [root, load]);
  return { drawingState, drawing };
}

/** Start to draw; null if the browser has no WebGL or refuses a context. */
function mount<T extends Drawing>(element: HTMLElement, make: (canvas: HTMLCanvasElement) => T) {
  if (!hasWebGl()) return null;
  const canvas = document.createElement("canvas");
  element.append(canvas);
  try {
    const drawing = make(canvas);
    const observer = new ResizeObserver(() =>
      drawing.resize(element.clientWidth, element.clientHeight),
    );
    observer.observe(element);
    const tidy = () => {
      observer.disconnect();
      drawing.dispose();
      canvas.remove();
    };
    return { drawing, tidy };
  } catch {
    canvas.remove();
    return null;
  }
}

/** Checked beforehand, because the library logs errors if there is no WebGL. */
function hasWebGl(): boolean {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}
