/** The avatars of the paper, named by their stature as on the server: `165cm`. */
export const PAPER_AVATARS: readonly string[] = ["130cm", "165cm", "190cm"];
export const MAX_AVATARS = 6;
const SMALLEST_CM = 50;
const LARGEST_CM = 260;
export const STATURE_LIMITS = { min: SMALLEST_CM, max: LARGEST_CM } as const;

export const statureOf = (avatar: string): number => Number.parseFloat(avatar);

/** The name of an avatar for a stature in centimetres; null for an impossible stature. */
export function avatarOf(stature_cm: number | string): string | null {
  const value = Math.round(Number(stature_cm) * 10) / 10;
  if (stature_cm === "" || !(value >= SMALLEST_CM && value <= LARGEST_CM)) return null;
  return `${value}cm`;
}

/** The avatars with one more, in order of stature, without duplicates. */
export const withAvatar = (avatars: readonly string[], more: string): readonly string[] =>
  [...new Set([...avatars, more])].toSorted((a, b) => statureOf(a) - statureOf(b));
