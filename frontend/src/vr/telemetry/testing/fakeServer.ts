/** A server of the protocol for tests: stores what fits, acknowledges, requests what is missing. */
import { decodeBatch } from "../wire/batch";
import type { Welcome } from "../wire/fromServer";

interface ReceivedMessage {
  readonly type: string;
  readonly epoch: number;
  readonly seq: number;
  readonly [field: string]: unknown;
}

export class FakeServer {
  /** Messages received from clients, other than batches, in the order of arrival. */
  readonly received: ReceivedMessage[] = [];
  /** Stored seqs as `stream/epoch/seq`, in the order of arrival. */
  readonly stored: string[] = [];
  readonly sockets: FakeSocket[] = [];
  readonly positions = new Map<string, number>();
  sessionId = "session";
  /** No connection succeeds while it is false. */
  isUp = true;
  /** How often a seq was skipped. */
  resends = 0;
  acknowledges = true;
  answersProbes = true;
  lastEpoch = 0;
  /** Fields to override in the next welcomes. */
  welcomeWith: Partial<Welcome> = {};
  /** The rejection of the next hello. */
  refusal: { code: number; error: object } | null = null;

  readonly makeSocket = (_url: string, protocols: string[]): WebSocket => {
    const socket = new FakeSocket(protocols, (data) => this.#receive(socket, data));
    this.sockets.push(socket);
    queueMicrotask(() => (this.isUp ? socket.open() : socket.breaks()));
    return socket as unknown as WebSocket;
  };

  get socket(): FakeSocket {
    const newest = this.sockets.at(-1);
    if (newest === undefined) throw new Error("nobody has connected");
    return newest;
  }

  broadcast(message: object): void {
    this.socket.receive(JSON.stringify(message));
  }

  breaks(): void {
    this.socket.breaks();
  }

  /** Break the connection, and every new one until `isUp` is true again. */
  goesDown(): void {
    this.isUp = false;
    this.breaks();
  }

  acknowledge(): void {
    this.broadcast({ type: "ack", positions: this.#positions });
  }

  storedOf(stream: string, epoch: number): readonly string[] {
    return this.stored.filter((one) => one.startsWith(`${stream}/${epoch}/`));
  }

  of(type: string): readonly ReceivedMessage[] {
    return this.received.filter((message) => message.type === type);
  }

  get #positions(): Welcome["positions"] {
    return [...this.positions].map(([key, next_seq]) => {
      const [stream = "", epoch = ""] = key.split("/");
      return { stream, epoch: Number(epoch), next_seq };
    });
  }

  #receive(socket: FakeSocket, data: string | Uint8Array<ArrayBuffer>): void {
    if (typeof data !== "string") {
      const { stream, epoch, seqFirst, timesS } = decodeBatch(data);
      this.#store(stream, epoch, seqFirst, timesS.length);
      return;
    }
    const message = JSON.parse(data) as ReceivedMessage;
    this.received.push(message);
    if (message.type === "hello") this.#greet(socket, message);
    else if (message.type === "report") this.#store("reports", message.epoch, message.seq, 1);
    else if (message.type === "probe" && this.answersProbes) {
      this.broadcast({ ...message, server_received_ns: 1, server_sent_ns: 2 });
    }
  }

  #greet(socket: FakeSocket, hello: ReceivedMessage): void {
    if (this.refusal !== null) {
      this.broadcast(this.refusal.error);
      socket.breaks(this.refusal.code);
      return;
    }
    if (hello.epoch === null) this.lastEpoch++;
    this.broadcast({
      ...welcome,
      ...this.#welcome(hello.epoch ?? this.lastEpoch),
      ...this.welcomeWith,
    });
  }

  #welcome(epoch: number): Partial<Welcome> {
    return { epoch, session_id: this.sessionId, positions: this.#positions };
  }

  #store(stream: string, epoch: number, seqFirst: number, count: number): void {
    const key = `${stream}/${epoch}`;
    const next = this.positions.get(key) ?? 0;
    if (seqFirst > next) {
      this.resends++;
      this.broadcast({ type: "resend", stream, epoch, next_seq: next });
      return;
    }
    for (let seq = next; seq < seqFirst + count; seq++) this.stored.push(`${key}/${seq}`);
    this.positions.set(key, Math.max(next, seqFirst + count));
    if (this.acknowledges) this.acknowledge();
  }
}

const welcome: Welcome = {
  type: "welcome",
  protocol: 1,
  session_id: "session",
  epoch: 1,
  time_scale: 1,
  language: "en",
  avatar: "delayed_copy",
  on_disconnect: "pause",
  undelayed_parts: ["Hips"],
  tasks: {},
  texts: {},
  positions: [],
  state: {
    type: "state",
    version: 1,
    status: "planned",
    step_index: null,
    step_kind: null,
    materialised: false,
    recording: false,
    phase: null,
    participant: { handedness: null, footedness: null, stature_m: null },
  },
};

export const stateOf = (version: number): Welcome["state"] => ({ ...welcome.state, version });

/**
 * The part of a WebSocket that the client uses. Everything arrives in a later turn, as from a
 * network.
 */
export class FakeSocket {
  readonly protocols: readonly string[];
  readyState: number = WebSocket.CONNECTING;
  binaryType = "blob";
  bufferedAmount = 0;
  /** Whether the network takes nothing: what is sent stays in the browser. */
  isStuck = false;
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: { code: number; reason: string }) => void) | null = null;
  readonly #sent: (data: string | Uint8Array<ArrayBuffer>) => void;

  constructor(
    protocols: readonly string[],
    sent: (data: string | Uint8Array<ArrayBuffer>) => void,
  ) {
    this.protocols = protocols;
    this.#sent = sent;
  }

  send(data: string | Uint8Array<ArrayBuffer>): void {
    if (this.isStuck) this.bufferedAmount += data.length;
    else queueMicrotask(() => this.#sent(data));
  }

  close(code = 1005, reason = ""): void {
    this.breaks(code, reason);
  }

  open(): void {
    this.readyState = WebSocket.OPEN;
    this.onopen?.();
  }

  receive(text: string): void {
    queueMicrotask(() => this.onmessage?.({ data: text }));
  }

  breaks(code = 1006, reason = ""): void {
    this.readyState = WebSocket.CLOSED;
    queueMicrotask(() => this.onclose?.({ code, reason }));
  }
}
