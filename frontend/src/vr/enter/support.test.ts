import { describe, expect, it } from "vitest";
import { deviceOf, supportOf } from "./support";

const QUEST =
  "Mozilla/5.0 (X11; Linux x86_64; Quest 3) AppleWebKit/537.36 (KHTML, like Gecko) OculusBrowser/41.3 Chrome/142.0 VR Safari/537.36";
const PICO =
  "Mozilla/5.0 (X11; Linux x86_64; PICO 4 Ultra) AppleWebKit/537.36 (KHTML, like Gecko) PicoBrowser/4.0.40 Chrome/105.0 VR Safari/537.36 OculusBrowser/7.0";
const VISION_PRO =
  "Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/18.0 Safari/605.1.15";
const DESKTOP =
  "Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/147.0 Safari/537.36";

const withXr = (isSessionSupported: () => Promise<boolean>) => ({
  isSecureContext: true,
  navigator: { xr: { isSessionSupported } },
});

describe("the device", () => {
  it("is told by the user agent, PICO before Quest, whose name it also has", () => {
    expect([QUEST, PICO, VISION_PRO, DESKTOP].map(deviceOf)).toEqual([
      "quest",
      "pico",
      "vision_pro",
      "computer",
    ]);
  });
});

describe("support", () => {
  it("needs a secure context before anything else", async () => {
    const insecure = { ...withXr(async () => true), isSecureContext: false };
    expect(await supportOf(insecure)).toBe("insecure");
  });

  it("tells a browser without WebXR from one that finds no headset", async () => {
    expect(await supportOf({ isSecureContext: true, navigator: {} })).toBe("no_webxr");
    expect(await supportOf(withXr(async () => false))).toBe("no_headset");
    const broken = withXr(() => Promise.reject(new Error("blocked")));
    expect(await supportOf(broken)).toBe("no_headset");
  });

  it("is ready once the browser says so", async () => {
    expect(await supportOf(withXr(async () => true))).toBe("ready");
  });
});
