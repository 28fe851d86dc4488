/** One WebSocket, from opening to its end, as promises. */
import type { Limits } from "../limits";
import { SUBPROTOCOL } from "../wire/basis";

/** How a socket ended. 1006: it broke, or never opened. */
export interface Ending {
  readonly code: number;
  readonly reason: string;
}

const BROKEN: Ending = { code: 1006, reason: "" };

export interface Address {
  /** `ws://HOST/api/vr/stream`, or `wss://`. */
  readonly url: string;
  readonly token: string;
}

export type MakeSocket = (url: string, protocols: string[]) => WebSocket;

export class Channel {
  /** Resolves once when the channel has ended, for whatever reason. */
  readonly ended: Promise<Ending>;
  readonly #socket: WebSocket;
  readonly #limits: Limits;
  readonly #onText: (text: string) => void;
  #end: (ending: Ending) => void = () => undefined;
  #isOpen = true;
  #watchdog: ReturnType<typeof setTimeout> | undefined;

  /** `onOpen` and `onText` are not called after the channel has ended. */
  constructor(
    address: Address,
    limits: Limits,
    make: MakeSocket,
    onOpen: () => void,
    onText: (text: string) => void,
  ) {
    this.#limits = limits;
    this.#onText = onText;
    this.ended = new Promise((resolve) => {
      this.#end = resolve;
    });
    this.#socket = make(address.url, [SUBPROTOCOL, `bearer.${address.token}`]);
    this.#socket.binaryType = "arraybuffer";
    this.#socket.onopen = () => this.#isOpen && onOpen();
    this.#socket.onmessage = ({ data }) => this.#receive(data);
    this.#socket.onclose = ({ code, reason }) => this.#finish({ code, reason });
    this.#watch(limits.openTimeoutS);
  }

  get isOpen(): boolean {
    return this.#isOpen;
  }

  send(message: string | Uint8Array<ArrayBuffer>): void {
    if (this.#isOpen && this.#socket.readyState === WebSocket.OPEN) this.#socket.send(message);
  }

  /** Resolves when the browser's send buffer is small enough, or the channel has ended. */
  async room(): Promise<void> {
    const { bufferedBytes, bufferPollS } = this.#limits;
    while (this.#isOpen && this.#socket.bufferedAmount >= bufferedBytes) {
      await new Promise((resolve) => setTimeout(resolve, bufferPollS * 1000));
    }
  }

  close(code: number, reason = ""): void {
    this.#finish({ code, reason });
  }

  /**
   * A network that vanished causes no event for minutes, so a connection that is silent for long is
   * closed.
   */
  #watch(silenceS: number): void {
    clearTimeout(this.#watchdog);
    this.#watchdog = setTimeout(() => this.#finish(BROKEN), silenceS * 1000);
  }

  #receive(data: unknown): void {
    if (!this.#isOpen) return;
    this.#watch(this.#limits.silenceS);
    if (typeof data === "string") this.#onText(data);
  }

  #finish(ending: Ending): void {
    if (!this.#isOpen) return;
    this.#isOpen = false;
    clearTimeout(this.#watchdog);
    // The closing handshake of a dead network takes long, so it is not awaited.
    const isOurs = ending.code === 1000 || ending.code >= 3000;
    if (this.#socket.readyState < WebSocket.CLOSING) {
      if (isOurs) this.#socket.close(ending.code, ending.reason);
      else this.#socket.close();
    }
    this.#end(ending);
  }
}
