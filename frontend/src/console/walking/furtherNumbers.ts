/** Further numbers of walks, such as a load: what they are called, with the unit of their name. */

/** The ends of names that are units, and how each is written. */
const UNITS: Readonly<Record<string, string>> = {
  ...Object.fromEntries(["kg", "g", "m", "cm", "mm", "s", "ms", "min"].map((unit) => [unit, unit])),
  ...{ m_s: "m/s", km_h: "km/h", rad_s: "rad/s", deg: "°", rad: "rad", hz: "Hz", n: "N", w: "W" },
  ...{ percent: "%", bpm: "bpm", db: "dB", lux: "lx", years: "years", lb: "lb", ft: "ft" },
};

export interface NamedNumber {
  readonly words: string;
  readonly unit: string | null;
}

/** The name's words and its unit: `load_kg` is a load in kg, `gaze_on_display` has no unit. */
export function namedNumber(name: string): NamedNumber {
  const parts = name.split("_").filter((part) => part !== "");
  for (const length of [2, 1]) {
    const unit = UNITS[parts.slice(-length).join("_").toLowerCase()];
    if (unit !== undefined && parts.length > length) {
      return { words: parts.slice(0, -length).join(" "), unit };
    }
  }
  return { words: parts.join(" "), unit: null };
}

/** The label of a field, such as `Load (kg)`. */
export function numberLabel(name: string): string {
  const { words, unit } = namedNumber(name);
  const label = words.charAt(0).toUpperCase() + words.slice(1);
  return unit === null ? label : `${label} (${unit})`;
}

const PAPERS: readonly string[] = ["length_m", "turning_per_m", "stature_m"];

/** Those dependencies of a model that a user named: all but length, turning and stature. */
export const furtherOf = (names: readonly string[]): readonly string[] =>
  names.filter((name) => !PAPERS.includes(name));

/** What a further number may be called, as the server checks it. */
export const isNumberName = (name: string): boolean =>
  /^[A-Za-z][A-Za-z0-9_]{0,39}$/.test(name) &&
  ![...PAPERS, "length", "turning", "stature"].includes(name.toLowerCase());
