/**
 * The emulated headset of tests: bundle a page of your own with it, or run it before the product's.
 *
 * `installEmulatedHeadset` replaces the page's clock and its WebXR; call it before three is imported.
 */
import { EmulatedHeadset, type EmulatedOptions } from "./emulatedHeadset";
import { installVirtualClock, type VirtualClock } from "./virtualClock";

export { EmulatedHeadset, type EmulatedOptions } from "./emulatedHeadset";
export { installVirtualClock, VirtualClock } from "./virtualClock";
export { Wearer, type WearerOptions } from "./wearer";

/** The clock first, since iwer and three take its frames. */
export function installEmulatedHeadset(options: EmulatedOptions = {}): {
  readonly clock: VirtualClock;
  readonly headset: EmulatedHeadset;
} {
  const { frameRateHz } = options;
  const clock = installVirtualClock(frameRateHz === undefined ? {} : { frameRateHz });
  return { clock, headset: new EmulatedHeadset(options) };
}
