/**
 * The socket of the study's road during one phase: it says where the participant is at each step, and
 * hears where everybody else is. Opened again whenever it breaks; nothing that was not heard is lost.
 */
import { SUBPROTOCOL } from "../telemetry";
import { type Actor, type FloorPlace, roadMessage } from "./wire";

const OPEN = 1;
const RETRY_S = [0.5, 1, 2, 5] as const;
/** The server refuses this headset or this phase; asking again does not help. */
const FINAL_CODES: ReadonlySet<number> = new Set([4400, 4401]);
const MOST_IN_MESSAGE = 512;

export interface RoadLinkOptions {
  readonly url: string;
  readonly token: string;
  readonly phaseId: number;
  readonly activeS: number;
  readonly place: FloorPlace;
  readonly makeSocket?: (url: string, protocols: string[]) => WebSocket;
}

/** Everybody else at one active time of the phase. */
export interface Others {
  readonly activeS: number;
  readonly actors: readonly Actor[];
}

const NOBODY: Others = { activeS: 0, actors: [] };

export class RoadLink {
  readonly #options: RoadLinkOptions;
  readonly #places: FloorPlace[] = [];
  #socket: WebSocket | null = null;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #failures = 0;
  #run: string | null = null;
  /** Places that this connection has sent; null until it was welcomed. */
  #said: number | null = null;
  #isRunning = false;
  #isClosed = false;
  #others = NOBODY;
  #problem: string | null = null;

  constructor(options: RoadLinkOptions) {
    this.#options = options;
    this.#open();
  }

  get others(): Others {
    return this.#others;
  }

  /** Why the scene broke off; null while it goes on. */
  get problem(): string | null {
    return this.#problem;
  }

  /** Whether the traffic has warmed up and goes on. */
  get hasTraffic(): boolean {
    return this.#others !== NOBODY && this.#problem === null;
  }

  /** Say where the participant was at the next steps, and whether the phase's clock runs. */
  say(places: readonly FloorPlace[], isRunning: boolean): void {
    this.#places.push(...places);
    if (isRunning !== this.#isRunning) {
      this.#isRunning = isRunning;
      if (this.#said !== null) this.#send({ type: "clock", running: isRunning });
    }
    this.#sayAll();
  }

  /** The phase is over. */
  close(): void {
    this.#isClosed = true;
    clearTimeout(this.#retry);
    // The server closes the socket once all is stored.
    this.#send({ type: "end" });
  }

  #open(): void {
    const { url, token, makeSocket, phaseId, activeS, place } = this.#options;
    const make = makeSocket ?? ((address, protocols) => new WebSocket(address, protocols));
    const socket = make(url, [SUBPROTOCOL, `bearer.${token}`]);
    this.#socket = socket;
    socket.onopen = () => {
      const hello = { type: "hello", phase_id: phaseId, active_s: activeS, place, run: this.#run };
      socket.send(JSON.stringify(hello));
    };
    socket.onmessage = ({ data }) => this.#receive(socket, String(data));
    socket.onclose = ({ code }) => this.#closed(socket, code);
  }

  #receive(socket: WebSocket, text: string): void {
    if (socket !== this.#socket) return;
    const message = roadMessage(text);
    if (message === null) return;
    this.#failures = 0;
    if (message.type === "actors") {
      this.#others = { activeS: message.active_s, actors: message.actors };
    } else if (message.type === "ended") {
      if (message.problem !== "") this.#problem = message.problem;
    } else {
      this.#run = message.run;
      this.#said = message.next_step;
      if (this.#isRunning) this.#send({ type: "clock", running: true });
      this.#sayAll();
    }
  }

  #sayAll(): void {
    if (this.#socket?.readyState !== OPEN) return;
    while (this.#said !== null && this.#said < this.#places.length) {
      const places = this.#places.slice(this.#said, this.#said + MOST_IN_MESSAGE);
      this.#send({ type: "places", first_step: this.#said, places });
      this.#said += places.length;
    }
  }

  #send(message: object): void {
    if (this.#socket?.readyState === OPEN) this.#socket.send(JSON.stringify(message));
  }

  #closed(socket: WebSocket, code: number): void {
    if (socket !== this.#socket) return;
    this.#said = null;
    if (this.#isClosed || this.#problem !== null) return;
    if (FINAL_CODES.has(code)) {
      this.#problem = "The server does not let this page on the road. Load it again.";
      return;
    }
    const waitS = RETRY_S[Math.min(this.#failures, RETRY_S.length - 1)] as number;
    this.#failures++;
    this.#retry = setTimeout(() => this.#open(), waitS * 1000);
  }
}
