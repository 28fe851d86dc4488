/** The socket over which the lab's trackers come: opened again whenever it breaks. */
import type { ServerTrackers } from "./trackers";
import { type HeadPose, trackersMessage } from "./wire";

const SUBPROTOCOL = "reembody.v1";
const OPEN = 1;
const RETRY_S = [0.5, 1, 2, 5] as const;
/** Another page of this headset has the trackers now, or it is not paired any more. */
const FINAL_CODES: ReadonlySet<number> = new Set([4400, 4401]);
/** Nobody needs the head's poses of a network that is stuck. */
const MOST_BUFFERED_BYTES = 64 * 1024;

export interface TrackerLinkOptions {
  readonly url: string;
  readonly token: string;
  readonly trackers: ServerTrackers;
  /** The page's monotonic clock, s. */
  readonly clock: () => number;
  readonly makeSocket?: (url: string, protocols: string[]) => WebSocket;
}

export class TrackerLink {
  readonly #options: TrackerLinkOptions;
  #socket: WebSocket | null = null;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #failures = 0;
  #isClosed = false;

  constructor(options: TrackerLinkOptions) {
    this.#options = options;
    this.#open();
  }

  /** End for good. */
  close(): void {
    this.#isClosed = true;
    clearTimeout(this.#retry);
    this.#options.trackers.sendHeadTo(null);
    this.#socket?.close();
    this.#socket = null;
  }

  #open(): void {
    const { url, token, makeSocket } = this.#options;
    const make = makeSocket ?? ((address, protocols) => new WebSocket(address, protocols));
    const socket = make(url, [SUBPROTOCOL, `bearer.${token}`]);
    this.#socket = socket;
    socket.onmessage = ({ data }) => this.#receive(socket, String(data));
    socket.onclose = ({ code }) => this.#closed(socket, code);
  }

  #receive(socket: WebSocket, text: string): void {
    if (this.#isClosed || socket !== this.#socket) return;
    const message = trackersMessage(text);
    if (message === null) return;
    this.#failures = 0;
    const { trackers, clock } = this.#options;
    if (message.type === "trackers_state") {
      trackers.sendHeadTo(message.wanted ? (poses) => sendHead(socket, poses) : null);
    }
    trackers.receive(message, clock());
  }

  #closed(socket: WebSocket, code: number): void {
    if (this.#isClosed || socket !== this.#socket) return;
    this.#options.trackers.sendHeadTo(null);
    if (FINAL_CODES.has(code)) return;
    const waitS = RETRY_S[Math.min(this.#failures, RETRY_S.length - 1)] as number;
    this.#failures++;
    this.#retry = setTimeout(() => this.#open(), waitS * 1000);
  }
}

function sendHead(socket: WebSocket, poses: readonly HeadPose[]): void {
  if (socket.readyState !== OPEN || socket.bufferedAmount > MOST_BUFFERED_BYTES) return;
  socket.send(JSON.stringify({ type: "head", poses }));
}
