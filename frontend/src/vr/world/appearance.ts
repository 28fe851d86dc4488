/** A study's palettes: the colours of its objects, and the shapes that say the same. */
import * as v from "valibot";

const colour = v.pipe(v.string(), v.regex(/^#[0-9a-f]{6}$/));
const cue = v.picklist(["none", "check", "cross", "ring", "stripes"]);
export type Cue = v.InferOutput<typeof cue>;

const Palette = v.object({
  key: v.string(),
  colours: v.object({
    panel: colour,
    panel_done: colour,
    side: colour,
    side_touched: colour,
    target: colour,
    start_square: colour,
  }),
  cues: v.object({ panel_done: cue, side_touched: cue, target: cue }),
});
export type Palette = v.InferOutput<typeof Palette>;

const Appearance = v.object({ default: v.string(), palettes: v.array(Palette) });

/**
 * The palette that is chosen, or the study's default, from the study's `appearance`.
 *
 * Throws `v.ValiError` for anything else; a key that the study does not have means its default.
 */
export function paletteOf(appearance: unknown, key?: string | null): Palette {
  const { default: usual, palettes } = v.parse(Appearance, appearance);
  const of = (wanted: string | null | undefined) => palettes.find((one) => one.key === wanted);
  return of(key) ?? of(usual) ?? palettes[0] ?? STANDARD;
}

/** Used where a server does not say how a study looks. */
export const STANDARD: Palette = {
  key: "standard",
  colours: {
    panel: "#8a8f98",
    panel_done: "#2f9e44",
    side: "#f4f5f7",
    side_touched: "#d6322c",
    target: "#2f9e44",
    start_square: "#ffffff",
  },
  cues: { panel_done: "none", side_touched: "none", target: "none" },
};
