/**
 * VR itself: the immersive session of WebXR, three's renderer, and the headset that they drive.
 *
 * One `Vr` lasts as long as the page. Its immersive session may end and be entered again any number
 * of times; the bodies, the phase and its record go on where they were, paused.
 */
import { PerspectiveCamera, Scene, WebGLRenderer } from "three";
import type { TelemetryClient } from "../telemetry";
import type { Headset } from "./headset";

export interface VrParts {
  readonly telemetry: TelemetryClient;
  readonly token: string;
  /** The immersive session has ended, whoever ended it. */
  readonly onEnd: () => void;
  readonly onFailure: (error: unknown) => void;
}

/** What the device granted, and how it draws; part of the record of what the participant saw. */
export interface Granted {
  readonly features: readonly string[];
  /** Hz as the device says; null if it does not. What is drawn is measured from the frames. */
  readonly frameRateHz: number | null;
  /** Fixed foveation as set, 0 (none) to 1 (the most); null where it cannot be set. */
  readonly foveation: number | null;
}

/** 90 Hz is what the recording and the study's bodies are made for. */
const FRAME_RATE_HZ = 90;
/** Browsers may never answer a request for a frame rate. */
const PATIENCE_MS = 2000;
/** three's own default is the most, which blurs text and hands at the edge of the view. */
const FOVEATION = 0.3;

const FEATURES = {
  requiredFeatures: ["local-floor"],
  optionalFeatures: ["hand-tracking", "bounded-floor", "body-tracking", "tracked-sources"],
} as const;

export class Vr {
  readonly #parts: VrParts;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(70, 1, 0.05, 50);
  #headset: Headset | null = null;
  #session: XRSession | null = null;
  #granted: Granted | null = null;

  constructor(parts: VrParts) {
    this.#parts = parts;
    this.#renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.#renderer.xr.enabled = true;
    this.#renderer.xr.setReferenceSpaceType("local-floor");
  }

  get granted(): Granted | null {
    return this.#granted;
  }

  /** Enter VR; call it in the handler of a click. */
  async enter(): Promise<void> {
    const xr = navigator.xr;
    if (xr === undefined) throw new Error("This browser has no WebXR.");
    const session = await xr.requestSession("immersive-vr", {
      requiredFeatures: [...FEATURES.requiredFeatures],
      optionalFeatures: [...FEATURES.optionalFeatures],
    });
    this.#session = session;
    session.addEventListener("end", () => this.#ended(session));
    session.addEventListener("visibilitychange", () => {
      if (session.visibilityState !== "visible") this.#headset?.leave(session.visibilityState);
    });
    await requestFrameRate(session);
    // Before the session is set: later it would start the window's loop beside the session's.
    this.#renderer.setAnimationLoop((timeMs, frame) => {
      if (frame !== undefined) this.#frame(timeMs, frame);
    });
    await this.#renderer.xr.setSession(session);
    this.#renderer.xr.setFoveation(FOVEATION);
    this.#granted = {
      features: session.enabledFeatures ?? [],
      frameRateHz: session.frameRate ?? null,
      foveation: this.#renderer.xr.getFoveation() ?? null,
    };
  }

  /** End VR, if it is shown, and free what it used. */
  dispose(): void {
    void this.#session?.end().catch(() => undefined);
    this.#headset?.dispose();
    this.#headset = null;
    this.#renderer.dispose();
  }

  #frame(timeMs: number, frame: XRFrame): void {
    this.#headset?.frame(timeMs / 1000, frame);
    this.#renderer.render(this.#scene, this.#camera);
  }

  #ended(session: XRSession): void {
    if (this.#session !== session) return;
    this.#session = null;
    this.#renderer.setAnimationLoop(null);
    this.#headset?.leave("ended");
    void this.#parts.telemetry.flush().catch(() => undefined);
    this.#parts.onEnd();
  }
}

/** Ask for the study's frame rate where the device can choose; it may still draw at another. */
async function requestFrameRate(session: XRSession): Promise<void> {
  if (session.updateTargetFrameRate === undefined) return;
  if (!session.supportedFrameRates?.includes(FRAME_RATE_HZ)) return;
  const patience = new Promise<void>((resolve) => {
    setTimeout(resolve, PATIENCE_MS);
  });
  const asked = session.updateTargetFrameRate(FRAME_RATE_HZ).catch(() => undefined);
  await Promise.race([asked, patience]);
}
