/**
 * What the machine's graphics manage: whether the browser draws in space, whether by a graphics
 * card, and with how many pixels it keeps up with what moves.
 */

/** Animation frames that come later than this one after another are too late, ms. */
const SLOW_MS = 30;
/** So early, the machine has time for more pixels, ms. */
const FAST_MS = 20;
/** How much one frame counts in the mean. */
const WEIGHT = 0.25;
/** Frames before a change, so that one late frame changes nothing: fewer to become coarser. */
const SLOW_FRAMES = 5;
const FAST_FRAMES = 240;
const STEP = 0.75;
/** A coarser picture would no longer show a hand at a box. */
const COARSEST = 0.4;

let inSoftware: boolean | null = null;

/** Whether the browser draws without a graphics card; asked once. */
export function isDrawnInSoftware(): boolean {
  inSoftware ??= !hasContext({ failIfMajorPerformanceCaveat: true });
  return inSoftware;
}

/** Checked beforehand, because the library logs errors if there is no WebGL. */
export function hasWebGl(): boolean {
  return hasContext({});
}

function hasContext(attributes: WebGLContextAttributes): boolean {
  try {
    const context = document.createElement("canvas").getContext("webgl2", attributes);
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}

/**
 * With how many pixels a picture of what moves live is drawn.
 *
 * Without a graphics card, as in a virtual machine or over a remote desktop, a picture in full size
 * takes longer than the next pose needs to come, and everything that is shown would be late. So
 * pictures become coarser until the machine keeps up, and are drawn finely again at rest.
 */
export class Sharpness {
  #meanMs = (SLOW_MS + FAST_MS) / 2;
  #frames = 0;

  /**
   * Pixels of the picture in a pixel of the page, along an edge: `still` at rest, the most that
   * there are, and `moving` while something moves.
   */
  constructor(
    readonly still: number,
    public moving = still,
  ) {}

  /** Take how long after a picture the next animation frame came, ms. */
  note(frameMs: number): void {
    this.#meanMs += WEIGHT * (frameMs - this.#meanMs);
    this.#frames += 1;
    if (this.#meanMs > SLOW_MS && this.#frames >= SLOW_FRAMES) {
      this.#change(Math.max(COARSEST, this.moving * STEP));
    } else if (this.#meanMs < FAST_MS && this.#frames >= FAST_FRAMES) {
      this.#change(Math.min(this.still, this.moving / STEP));
    }
  }

  #change(moving: number): void {
    this.moving = moving;
    this.#frames = 0;
    this.#meanMs = (SLOW_MS + FAST_MS) / 2;
  }
}
