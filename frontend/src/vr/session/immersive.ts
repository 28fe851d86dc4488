/** The immersive session of WebXR as this page asks for it, whatever is shown in it. */
import type { WebGLRenderer } from "three";
import type { Granted } from "./inspection";

/** 90 Hz is what the recording and the study's bodies are made for. */
export const FRAME_RATE_HZ = 90;
/** Browsers may never answer a request for a frame rate. */
const PATIENCE_MS = 2000;
/** three's own default is the most, which blurs text and hands at the edge of the view. */
const FOVEATION = 0.3;

const REQUIRED = ["local-floor"] as const;
const OPTIONAL = ["hand-tracking", "bounded-floor", "body-tracking", "tracked-sources"] as const;

/** Ask for a session; call it in the handler of a click, in which browsers allow it. */
export async function requestImmersive(): Promise<XRSession> {
  const xr = navigator.xr;
  if (xr === undefined) throw new Error("This browser has no WebXR.");
  return xr.requestSession("immersive-vr", {
    requiredFeatures: [...REQUIRED],
    optionalFeatures: [...OPTIONAL],
  });
}

/** Draw in a session: `onFrame` is called for each of its frames. Resolves to what was granted. */
export async function drawIn(
  renderer: WebGLRenderer,
  session: XRSession,
  onFrame: (timeMs: number, frame: XRFrame) => void,
): Promise<Granted> {
  await requestFrameRate(session);
  // Before the session is set: later it would start the window's loop beside the session's.
  renderer.setAnimationLoop((timeMs, frame) => {
    if (frame !== undefined) onFrame(timeMs, frame);
  });
  await renderer.xr.setSession(session);
  renderer.xr.setFoveation(FOVEATION);
  return {
    features: session.enabledFeatures ?? [],
    frameRateHz: session.frameRate ?? null,
    foveation: renderer.xr.getFoveation() ?? null,
  };
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
