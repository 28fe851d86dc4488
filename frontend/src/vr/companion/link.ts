/**
 * The companion as the server sends it: who it is, and their newest pose. The socket is opened again
 * whenever it breaks; meanwhile the companion stays as they were.
 */
import { SUBPROTOCOL, VALUES_PER_FRAME } from "../telemetry";
import { type CompanionState, companionPose, companionState } from "./wire";

const OPEN = 1;
const RETRY_S = [0.5, 1, 2, 5] as const;
/** Another page of this headset shows the companion now, or it is not paired any more. */
const FINAL_CODES: ReadonlySet<number> = new Set([4400, 4401]);

/** Who is shown: the body of a stature, drawn with a model of the lab or as a plain one. */
export interface CompanionBody {
  readonly statureM: number;
  readonly model: string | null;
}

export interface CompanionLinkOptions {
  readonly url: string;
  readonly token: string;
  /** Another body is shown from now on; null: nobody. */
  readonly onBody: (body: CompanionBody | null) => void;
  readonly makeSocket?: (url: string, protocols: string[]) => WebSocket;
}

export class CompanionLink {
  readonly #options: CompanionLinkOptions;
  #socket: WebSocket | null = null;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #failures = 0;
  #isClosed = false;
  #state: CompanionState | null = null;
  #pose: Float32Array | null = null;
  #isSeen = false;

  constructor(options: CompanionLinkOptions) {
    this.#options = options;
    this.#open();
  }

  /** Whether they are seen during tasks at the boxes, too. */
  get isInTasks(): boolean {
    return this.#state?.in_tasks ?? false;
  }

  /**
   * Say whether the participant sees the companion in this frame; returns their newest pose, null
   * while they are not seen or no pose has come.
   */
  look(wants: boolean): Float32Array | null {
    const isSeen = wants && this.#state?.chosen === true;
    if (isSeen !== this.#isSeen) {
      this.#isSeen = isSeen;
      this.#say();
    }
    return isSeen ? this.#pose : null;
  }

  /** End for good. */
  close(): void {
    this.#isClosed = true;
    clearTimeout(this.#retry);
    this.#socket?.close();
    this.#socket = null;
  }

  #open(): void {
    const { url, token, makeSocket } = this.#options;
    const make = makeSocket ?? ((address, protocols) => new WebSocket(address, protocols));
    const socket = make(url, [SUBPROTOCOL, `bearer.${token}`]);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    // A new connection does not know yet.
    socket.onopen = () => this.#isSeen && this.#say();
    socket.onmessage = ({ data }) => this.#receive(socket, data);
    socket.onclose = ({ code }) => this.#closed(socket, code);
  }

  #receive(socket: WebSocket, data: unknown): void {
    if (this.#isClosed || socket !== this.#socket) return;
    if (data instanceof ArrayBuffer) {
      this.#pose = companionPose(data, VALUES_PER_FRAME) ?? this.#pose;
      return;
    }
    const state = companionState(String(data));
    if (state === null) return;
    this.#failures = 0;
    const before = this.#state;
    this.#state = state;
    if (!isSameBody(before, state)) {
      this.#pose = null;
      const { chosen, stature_m: statureM, model } = state;
      this.#options.onBody(chosen ? { statureM, model } : null);
    }
  }

  #say(): void {
    if (this.#socket?.readyState !== OPEN) return;
    this.#socket.send(JSON.stringify({ type: "companion_seen", seen: this.#isSeen }));
  }

  #closed(socket: WebSocket, code: number): void {
    if (this.#isClosed || socket !== this.#socket || FINAL_CODES.has(code)) return;
    const waitS = RETRY_S[Math.min(this.#failures, RETRY_S.length - 1)] as number;
    this.#failures++;
    this.#retry = setTimeout(() => this.#open(), waitS * 1000);
  }
}

function isSameBody(before: CompanionState | null, now: CompanionState): boolean {
  if (before === null || !before.chosen || !now.chosen) return before?.chosen === now.chosen;
  return before.stature_m === now.stature_m && before.model === now.model;
}
