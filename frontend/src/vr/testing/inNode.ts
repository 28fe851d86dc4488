/**
 * The emulated headset without a browser, for unit tests: the few things of a page that iwer
 * touches, a WebGL context that draws nothing, and a clock of its own.
 *
 * What is drawn needs a browser; what is tracked does not.
 */
import { EmulatedHeadset, type EmulatedOptions } from "./emulatedHeadset";
import { installVirtualClock, type VirtualClock } from "./virtualClock";

interface Page {
  document?: unknown;
  window?: unknown;
  WebGL2RenderingContext?: unknown;
  requestAnimationFrame?: unknown;
  cancelAnimationFrame?: unknown;
  localStorage?: unknown;
  DOMPointReadOnly?: unknown;
}

const NAMES = [
  "document",
  "window",
  "WebGL2RenderingContext",
  "requestAnimationFrame",
  "cancelAnimationFrame",
  "localStorage",
  "DOMPointReadOnly",
] as const;

/** An immersive session that runs, and whose frames a test steps. */
export interface SessionInNode {
  readonly clock: VirtualClock;
  readonly headset: EmulatedHeadset;
  readonly session: XRSession;
  readonly floor: XRReferenceSpace;
  /** Step the clock by a frame and look at it. */
  frame<Seen>(look: (timeS: number, frame: XRFrame) => Seen): Seen;
  /** Give the process its own globals back; every test must. */
  close(): void;
}

export async function sessionInNode(options: EmulatedOptions = {}): Promise<SessionInNode> {
  const page = globalThis as unknown as Page;
  const before = new Map(NAMES.map((name) => [name, Object.getOwnPropertyDescriptor(page, name)]));
  const element = () => ({
    dataset: {},
    style: {},
    appendChild: () => undefined,
    removeChild: () => undefined,
  });
  const body = element();
  class WebGL2RenderingContext {}
  Object.assign(page, {
    document: { createElement: element, body },
    window: { innerWidth: 960, innerHeight: 480, dispatchEvent: () => true },
    WebGL2RenderingContext,
    requestAnimationFrame: () => 0,
    cancelAnimationFrame: () => undefined,
    DOMPointReadOnly: PointInNode,
    localStorage: { getItem: () => null, setItem: () => undefined },
  });
  const clock = installVirtualClock(
    options.frameRateHz === undefined ? {} : { frameRateHz: options.frameRateHz },
  );
  const headset = new EmulatedHeadset(options);
  const close = (): void => {
    headset.uninstall();
    clock.uninstall();
    for (const [name, descriptor] of before) {
      if (descriptor === undefined) Reflect.deleteProperty(page, name);
      else Object.defineProperty(page, name, descriptor);
    }
  };
  try {
    const session = (await navigator.xr?.requestSession("immersive-vr", {
      requiredFeatures: ["local-floor"],
      optionalFeatures: ["bounded-floor", "hand-tracking", "body-tracking", "tracked-sources"],
    })) as XRSession;
    const floor = await session.requestReferenceSpace("local-floor");
    const context = blindContext(element());
    const layer = new XRWebGLLayer(session, context as unknown as WebGL2RenderingContext_);
    await session.updateRenderState({ baseLayer: layer });
    const frame = <Seen>(look: (timeS: number, frame: XRFrame) => Seen): Seen => {
      const seen: Seen[] = [];
      const errors: unknown[] = [];
      session.requestAnimationFrame((timeMs, xr) => {
        // iwer would only write what is thrown here to the console.
        try {
          seen.push(look(timeMs / 1000, xr));
        } catch (error) {
          errors.push(error);
        }
      });
      clock.step();
      if (errors.length > 0) throw errors[0];
      if (seen.length === 0) throw new Error("The emulated headset drew no frame.");
      return seen[0] as Seen;
    };
    // The session takes its layer with its first frame.
    clock.step();
    return { clock, headset, session, floor, frame, close };
  } catch (error) {
    close();
    throw error;
  }
}

type WebGL2RenderingContext_ = ConstructorParameters<typeof XRWebGLLayer>[1];

class PointInNode {
  constructor(
    readonly x = 0,
    readonly y = 0,
    readonly z = 0,
    readonly w = 1,
  ) {}
}

/** A context whose every call does nothing; iwer clears it before each frame. */
function blindContext(canvas: object): object {
  const size = { width: 960, height: 480, parentElement: null };
  return new Proxy(
    { canvas: Object.assign(canvas, size), getParameter: () => [0, 0, 0, 0] },
    { get: (known, name) => Reflect.get(known, name) ?? (() => null) },
  );
}
