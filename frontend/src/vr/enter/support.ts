/**
 * Whether this browser can enter VR, and what to do if it cannot, depending on the device.
 *
 * Browsers offer WebXR to secure contexts only: https with a certificate that they accept, or
 * localhost (a headset's own, over a USB cable).
 */

export const DEVICES = ["quest", "pico", "vision_pro", "android_xr", "computer"] as const;
export type Device = (typeof DEVICES)[number];

/** What is in the way of VR; `ready` if nothing is. */
export const OBSTACLES = ["insecure", "no_webxr", "no_headset"] as const;
export type Support = "ready" | (typeof OBSTACLES)[number];

/** The device that a user agent belongs to. PICO's also names Oculus, so it is tested first. */
export function deviceOf(userAgent: string): Device {
  if (/PicoBrowser|Pico\b/i.test(userAgent)) return "pico";
  if (/OculusBrowser|Quest/i.test(userAgent)) return "quest";
  if (/Android XR|AndroidXR/i.test(userAgent)) return "android_xr";
  if (/Vision ?Pro|visionOS/i.test(userAgent)) return "vision_pro";
  // Safari of visionOS calls itself that of an iPad or a Mac; of these only it offers WebXR.
  const isSafari = /Macintosh|iPad/.test(userAgent) && !/Chrome|Chromium|Firefox/.test(userAgent);
  return isSafari && /Safari/.test(userAgent) ? "vision_pro" : "computer";
}

/** What the browser says about itself; `globalThis` fits. */
export interface Browser {
  readonly isSecureContext: boolean;
  readonly navigator: { readonly xr?: Pick<XRSystem, "isSessionSupported"> | undefined };
}

export async function supportOf({ isSecureContext, navigator }: Browser): Promise<Support> {
  if (!isSecureContext) return "insecure";
  if (navigator.xr === undefined) return "no_webxr";
  const isSupported = await navigator.xr.isSessionSupported("immersive-vr").catch(() => false);
  return isSupported ? "ready" : "no_headset";
}
