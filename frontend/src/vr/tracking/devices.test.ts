import { describe, expect, it } from "vitest";
import {
  DEVICE_PROFILES,
  type DeviceKey,
  deviceKeyOf,
  legsOfBodyTracking,
  waysForFeet,
} from "./devices";

const AGENTS: readonly (readonly [DeviceKey, string])[] = [
  [
    "pico",
    "Mozilla/5.0 (X11; Linux x86_64; PICO 4 OS5.4.0 like Quest) AppleWebKit/537.36 (KHTML, like Gecko) PicoBrowser/3.3.38 Chrome/105.0.5195.68 VR Safari/537.36 OculusBrowser/7.0",
  ],
  [
    "quest",
    "Mozilla/5.0 (X11; Linux x86_64; Quest 3) AppleWebKit/537.36 (KHTML, like Gecko) OculusBrowser/34.1.0 Chrome/126.0.6478.122 VR Safari/537.36",
  ],
  [
    "other",
    "Mozilla/5.0 (Windows NT 10.0; Win64; x64) AppleWebKit/537.36 Chrome/147.0 Safari/537.36",
  ],
];

describe("The table of devices", () => {
  it.each(AGENTS)("finds %s by its user agent", (key, agent) => {
    expect(deviceKeyOf(agent)).toBe(key);
  });

  it("lets only measured legs do the foot task: not those that a Quest makes up", () => {
    const feet = Object.keys(DEVICE_PROFILES).map((key) => [
      key,
      waysForFeet(key as DeviceKey).map(({ source }) => source),
    ]);
    expect(Object.fromEntries(feet)).toEqual({
      pico: ["body_tracking", "server_trackers"],
      quest: ["shin_controllers", "server_trackers"],
      vision_pro: ["server_trackers"],
      android_xr: ["server_trackers"],
      other: ["server_trackers"],
    });
    expect(legsOfBodyTracking("quest")).toBe("inferred");
    expect(legsOfBodyTracking("other")).toBe("inferred");
    expect(legsOfBodyTracking("pico")).toBe("tracked");
  });
});
