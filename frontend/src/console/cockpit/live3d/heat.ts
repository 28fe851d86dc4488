/**
 * Joint errors as colours: based on the plasma map, which is readable with any kind of colour
 * vision.
 */

/** The end of every scale of joint errors, degrees: larger errors are shown like this one. */
export const FULL_SCALE_DEG = 60;

const STOPS = ["#7d4be0", "#b0429f", "#dc5b6b", "#f48849", "#fcce25"] as const;
/** The colour of an unknown error. */
const UNKNOWN = "#8a9898";

type Rgb = readonly [red: number, green: number, blue: number];

const rgbOf = (hex: string): Rgb => {
  const value = Number.parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
};

export function heatColour(degrees: number | null | undefined): string {
  if (degrees == null || !Number.isFinite(degrees)) return UNKNOWN;
  const at = Math.min(Math.max(degrees / FULL_SCALE_DEG, 0), 1) * (STOPS.length - 1);
  const low = Math.min(Math.floor(at), STOPS.length - 2);
  const from = rgbOf(STOPS[low] ?? UNKNOWN);
  const to = rgbOf(STOPS[low + 1] ?? UNKNOWN);
  const mixed = from.map((part, index) =>
    Math.round(part + (at - low) * ((to[index] ?? part) - part)),
  );
  return `#${mixed.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

export const LEGEND = `linear-gradient(to right, ${STOPS.join(", ")})`;
