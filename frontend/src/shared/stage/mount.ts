/** A drawing in space on a canvas of its own, as large as the element that it stands in. */

export interface Drawing {
  resize(width: number, height: number): void;
  dispose(): void;
}

export interface Mounted<T extends Drawing> {
  readonly drawing: T;
  readonly tidy: () => void;
}

/** Begin to draw; null where the browser has no WebGL, or gives none. */
export function mount<T extends Drawing>(
  element: HTMLElement,
  make: (canvas: HTMLCanvasElement) => T,
): Mounted<T> | null {
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

/** Asked beforehand, because the library complains aloud where there is none. */
function hasWebGl(): boolean {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}
