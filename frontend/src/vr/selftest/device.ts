/** What the browser says about the device, and which of its inputs moved the body. */
import type { TrackedFrame, TrackingDevice, TrackingSource } from "../tracking/tracked";
import type { Report } from "./report";

type Input = Report["device"]["inputs"][number];

const INPUTS: Readonly<Record<TrackingDevice, Input | null>> = {
  headset: null,
  controller: "controllers",
  hand: "hands",
  body: "body",
  tracker: "trackers",
  joint: null,
};

/** The inputs of a frame from devices that somebody wears. */
export function inputsOf(
  { parts }: Pick<TrackedFrame, "parts">,
  kind: TrackingSource["kind"],
): readonly Input[] {
  if (kind === "desktop") return ["desktop"];
  if (kind === "script" || kind === "capture") return ["scripted"];
  return Object.values(parts).flatMap(({ place, device }) => {
    if (place === null || device === null) return [];
    if (device === "tracker" && kind === "shin_controllers") return ["shins"];
    return INPUTS[device] ?? [];
  });
}

const NAMES = /\b((?:Quest|PICO|Pico)(?: [A-Za-z0-9]+)*)/;

/** What people call the device, such as `Quest 3`; null if its browser does not tell. */
export function deviceName(userAgent: string): string | null {
  // Only in the part about the system: the browsers' own names come after it.
  const system = /\(([^)]*)\)/.exec(userAgent)?.[1] ?? "";
  return NAMES.exec(system)?.[1] ?? null;
}

/** Memory that the page's scripts use, bytes; null where the browser does not tell. */
export function memoryBytes(of: object = performance): number | null {
  const { memory } = of as { memory?: { usedJSHeapSize?: number } };
  return memory?.usedJSHeapSize ?? null;
}
