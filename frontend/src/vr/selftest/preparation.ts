/**
 * What a self-test waits for before it measures, and for how long: by the wall's clock, because a
 * device that draws nothing has no frames to count.
 */

/** `body`: the model and its worker; `sending`: the socket; `picture`: the first computed body. */
export const AWAITED = ["body", "sending", "picture"] as const;
export type Awaited = (typeof AWAITED)[number];

/** What is not there by then is missing in the report, s. */
export const PREPARED_WITHIN_S = 30;

export class Preparation {
  readonly #missing = new Set<Awaited>(AWAITED);

  /** `sinceS`: when it began, on the page's monotonic clock. */
  constructor(readonly sinceS: number) {}

  /** This is there, or has failed and will not come. */
  settled(what: Awaited): void {
    this.#missing.delete(what);
  }

  /** What is missing, in the order in which it is said. */
  get missing(): readonly Awaited[] {
    return AWAITED.filter((what) => this.#missing.has(what));
  }

  /** Whether the measurement begins: everything is there, or has been waited for long enough. */
  isOver(nowS: number): boolean {
    return this.#missing.size === 0 || this.isLate(nowS);
  }

  isLate(nowS: number): boolean {
    return nowS - this.sinceS >= PREPARED_WITHIN_S;
  }

  /** How far it is, for who waits. */
  progress(nowS: number) {
    const [awaited = "picture"] = this.missing;
    const waitedS = Math.min(PREPARED_WITHIN_S, Math.max(0, Math.floor(nowS - this.sinceS)));
    return { kind: "preparing", awaited, waitedS } as const;
  }
}
