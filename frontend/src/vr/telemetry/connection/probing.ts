/**
 * Asking for the server's clock again and again, and telling the raw reading of each exchange.
 *
 * An answer that takes too long is told as null, never as a number; when it comes after all, it is
 * ignored. Questions that were open when the connection broke are forgotten with it.
 */
import type { Limits } from "../limits";
import { probedText, textOf } from "../wire/fromClient";
import type { ProbeAnswer } from "../wire/fromServer";

export class Prober {
  readonly #send: (text: string) => void;
  readonly #clock: () => number;
  readonly #timeoutMs: number;
  readonly #asking: ReturnType<typeof setInterval>;
  /** Client time of the question -> what gives up on it. */
  readonly #asked = new Map<number, ReturnType<typeof setTimeout>>();

  constructor(send: (text: string) => void, clock: () => number, limits: Limits) {
    this.#send = send;
    this.#clock = clock;
    this.#timeoutMs = limits.probeTimeoutS * 1000;
    this.#ask();
    this.#asking = setInterval(() => this.#ask(), limits.probeEveryS * 1000);
  }

  /** `receivedS`: client time at which the answer came. */
  take(answer: ProbeAnswer, receivedS: number): void {
    const giveUp = this.#asked.get(answer.client_sent_s);
    if (giveUp === undefined) return;
    clearTimeout(giveUp);
    this.#asked.delete(answer.client_sent_s);
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
    for (const giveUp of this.#asked.values()) clearTimeout(giveUp);
    this.#asked.clear();
  }

  #ask(): void {
    const sentS = this.#clock();
    const giveUp = () => {
      this.#asked.delete(sentS);
      this.#send(probedText(sentS, null));
    };
    this.#asked.set(sentS, setTimeout(giveUp, this.#timeoutMs));
    this.#send(textOf({ type: "probe", client_sent_s: sentS }));
  }
}
