/** The range of a picture of curves. */

/** A range and round marks on it that hold all values, and at least `least` in either direction. */
export function scaleOf(
  low: number,
  high: number,
  least: number,
): { readonly low: number; readonly high: number; readonly marks: readonly number[] } {
  const middle = (low + high) / 2;
  const from = Math.min(low, middle - least);
  const to = Math.max(high, middle + least);
  const rough = (to - from) / 3;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5, 10].find((one) => one * power >= rough) ?? 10) * power;
  const first = Math.floor(from / step);
  const last = Math.ceil(to / step);
  const marks = Array.from({ length: last - first + 1 }, (_, n) =>
    Number(((first + n) * step).toPrecision(6)),
  );
  return { low: first * step, high: last * step, marks };
}
