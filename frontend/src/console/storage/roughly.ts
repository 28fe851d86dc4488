/** Two digits that count: a forecast is no more exact than the mean it comes from. */
export function roughly(count: number): number {
  if (count < 100) return count;
  const step = 10 ** (Math.floor(Math.log10(count)) - 1);
  return Math.floor(count / step) * step;
}
