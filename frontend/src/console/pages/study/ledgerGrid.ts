/** The ledger as a grid: a row for every order, a column for every replicate. */
import type { Ledger, Slot } from "@shared/api/types";

export interface LedgerRow {
  readonly sequence: readonly number[];
  /** One slot for each column; undefined where a replicate has no such order (yet). */
  readonly slots: readonly (Slot | undefined)[];
}

export interface LedgerGrid {
  readonly rows: readonly LedgerRow[];
  readonly columns: readonly number[];
}

/** The grid; null where the orders are hidden or no slot exists yet. */
export function arrange(ledger: Ledger): LedgerGrid | null {
  const { sequences } = ledger;
  if (sequences === null || ledger.slots.length === 0) return null;
  const columns = [...new Set(ledger.slots.map((slot) => slot.replicate))].sort((a, b) => a - b);
  const place = (slot: Slot): string => `${slot.sequence?.join("-")}/${slot.replicate}`;
  const slots = new Map(ledger.slots.map((slot) => [place(slot), slot]));
  const rows = sequences.map(({ sequence }) => ({
    sequence,
    slots: columns.map((column) => slots.get(`${sequence.join("-")}/${column}`)),
  }));
  return { rows, columns };
}

/** The index of the slot the next participant gets; null when every slot is taken. */
export function nextFree(slots: readonly Slot[]): number | null {
  const free = slots.filter((slot) => slot.state === "free").map((slot) => slot.index);
  return free.length === 0 ? null : Math.min(...free);
}
