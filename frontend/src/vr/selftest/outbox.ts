/**
 * Reports that the server has not confirmed yet, kept on the device: a reload, an empty battery or a
 * server that is away loses none. Sending one twice is harmless, since its id is its own.
 */
import { ApiError, answer, server } from "@shared/api/request";
import type { Report, SelfTestView } from "./report";

export type Keep = Pick<Storage, "getItem" | "setItem" | "removeItem">;

/** A request that a vanished server never answers is given up, and made again later, ms. */
const PATIENCE_MS = 8000;

/** Sends a report; throws ApiError or Unreachable. */
export type Send = (report: Report) => Promise<SelfTestView>;

export const sendWith =
  (token: string): Send =>
  (report) =>
    answer<SelfTestView>(
      server.POST("/api/vr/self-tests", {
        headers: { authorization: `Bearer ${token}` },
        body: report,
        signal: AbortSignal.timeout(PATIENCE_MS),
      }),
    );

/** A report that the server does not take, and why. */
export interface Refusal {
  readonly id: string;
  readonly error: ApiError;
}

/** Whether an answer will be the same however often the report is sent. */
const isFinal = ({ status }: ApiError): boolean => REFUSED.has(status);
/** Malformed, unlike the stored one of this id, too large, or not valid; a pairing can be renewed. */
const REFUSED: ReadonlySet<number> = new Set([400, 409, 413, 422]);

/** The wait before a next try, ms: twice as long each time, at most a minute. */
export const waitMs = (failures: number): number => Math.min(60_000, 3000 * 2 ** failures);

/** How sending the reports ended: stored ones with their verdicts, and why others still wait. */
export interface Delivered {
  readonly stored: readonly SelfTestView[];
  readonly waiting: number;
  /** Those among them that the server refused for good: sending them again changes nothing. */
  readonly refused: readonly Refusal[];
  /** Null if nothing waits. */
  readonly error: unknown;
}

const KEY = "reembody.vr.self-tests";

export class Outbox {
  readonly #keep: Keep;
  #unfinished: string | null = null;
  #underway: Promise<Delivered> | null = null;

  constructor(keep: Keep = localStorage) {
    this.#keep = keep;
  }

  /** The reports that wait, the oldest first. */
  get reports(): readonly Report[] {
    try {
      const kept: unknown = JSON.parse(this.#keep.getItem(KEY) ?? "[]");
      return Array.isArray(kept) ? (kept as readonly Report[]) : [];
    } catch {
      return [];
    }
  }

  /** Keep a report that is not whole yet: this page does not send it before it is added. */
  keep(report: Report): void {
    this.add(report);
    this.#unfinished = report.id;
  }

  /** Keep a report; it replaces an earlier state of itself. */
  add(report: Report): void {
    this.#unfinished = null;
    this.#write([...this.reports.filter(({ id }) => id !== report.id), report]);
  }

  /** Give up reports for good. */
  discard(ids: readonly string[]): void {
    this.#write(this.reports.filter(({ id }) => !ids.includes(id)));
  }

  /** Send everything that waits, once at a time. */
  deliver(send: Send): Promise<Delivered> {
    this.#underway ??= this.#deliver(send).finally(() => {
      this.#underway = null;
    });
    return this.#underway;
  }

  async #deliver(send: Send): Promise<Delivered> {
    const stored: SelfTestView[] = [];
    const refused: Refusal[] = [];
    let error: unknown = null;
    for (const report of this.reports) {
      if (report.id === this.#unfinished) continue;
      try {
        stored.push(await send(report));
        this.#write(this.reports.filter(({ id }) => id !== report.id));
      } catch (reason) {
        error = reason;
        if (reason instanceof ApiError && isFinal(reason)) {
          refused.push({ id: report.id, error: reason });
        }
        // One that the server cannot take does not hold up the others; without a server none goes.
        if (!(reason instanceof ApiError)) break;
      }
    }
    return { stored, waiting: this.reports.length, refused, error };
  }

  #write(reports: readonly Report[]): void {
    if (reports.length === 0) this.#keep.removeItem(KEY);
    else this.#keep.setItem(KEY, JSON.stringify(reports));
  }
}
