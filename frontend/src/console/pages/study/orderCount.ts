import type { StudyProtocol } from "@shared/api/types";

/** The number of orders in a study's design: as many as one block of its ledger has rows. */
export function orderCount({ design, sequences }: StudyProtocol["orders"], n: number): number {
  if (design === "explicit") return sequences?.length ?? 0;
  if (design === "williams") return n % 2 === 0 || n === 1 ? n : 2 * n;
  return factorial(n);
}

const factorial = (n: number): number => (n <= 1 ? 1 : n * factorial(n - 1));
