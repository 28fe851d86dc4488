/**
 * Probe the server's clock at regular intervals, and report the raw reading of each exchange.
 *
 * An answer that takes too long is reported as null, never as a number; if it arrives later, it is
 * ignored. Probes that are unanswered when the connection breaks are dropped.
 */
import type { Limits } from "../limits";
import { probedText, textOf } from "../wire/fromClient";
import type { ProbeAnswer } from "../wire/fromServer";

export class Prober {
  readonly #send: (text: string) => void;
  readonly #clock: () => number;
  readonly #timeoutMs: number;
  readonly #asking: ReturnType<typeof setInterval>;
  /** Client time of each unanswered probe -> the timer that gives up on it. */
  readonly #unanswered = new Map<number, ReturnType<typeof setTimeout>>();

  constructor(send: (text: string) => void, clock: () => number, limits: Limits) {
    this.#send = send;
    this.#clock = clock;
    this.#timeoutMs = limits.probeTimeoutS * 1000;
    this.#ask();
    this.#asking = setInterval(() => this.#ask(), limits.probeEveryS * 1000);
  }

  /** Handle an answer; `receivedS` is the client time at which it arrived. */
  take(answer: ProbeAnswer, receivedS: number): void {
    const giveUp = this.#unanswered.get(answer.client_sent_s);
    if (giveUp === undefined) return;
    clearTimeout(giveUp);
    this.#unanswered.delete(answer.client_sent_s);
    this.#send(
      probedText(answer.client_sent_s, {
        serverReceivedNs: answer.server_received_ns,
        serverSentNs: answer.server_sent_ns,
        clientReceivedS: receivedS,
      }),
    );
  }

  stop(): void {
    clearInterval(this.#asking);
    for (const giveUp of this.#unanswered.values()) clearTimeout(giveUp);
    this.#unanswered.clear();
  }

  #ask(): void {
    const sentS = this.#clock();
    const giveUp = () => {
      this.#unanswered.delete(sentS);
      this.#send(probedText(sentS, null));
    };
    this.#unanswered.set(sentS, setTimeout(giveUp, this.#timeoutMs));
    this.#send(textOf({ type: "probe", client_sent_s: sentS }));
  }
}
