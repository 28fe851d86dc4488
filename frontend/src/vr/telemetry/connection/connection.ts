/**
 * Keep a headset connected: connect, send hello, listen, and reconnect, until it is closed or
 * rejected.
 *
 * A broken connection is not an error. Only a rejection by the server is final: an `error` message,
 * or
 * a close code that another attempt would meet again.
 */
import type { Failure } from "../failure";
import { PROTOCOL_VERSION } from "../wire/basis";
import { textOf } from "../wire/fromClient";
import {
  type Flag,
  type HeadsetState,
  type RefusedReport,
  type ServerMessage,
  serverMessage,
  type Welcome,
} from "../wire/fromServer";
import { type Address, Channel, type Ending, type MakeSocket } from "./channel";
import { Conversation, type Parts } from "./conversation";

/**
 * What the server reports about something it stored: flagged samples, or a report that did not fit.
 */
export type Notice = Flag | RefusedReport;

/** What a client can do, as its hello says; nothing of it by default. */
export interface Abilities {
  /** The kinds of avatar that it can show; only `delayed_copy` by default. */
  readonly avatars?: readonly string[];
  /** It can change a physics avatar while it runs: the state has `avatar_changes`. */
  readonly changesAvatar?: boolean;
  /** It reports how the goals are known (`goals`), from the first frame on. */
  readonly goals?: boolean;
  /** It shows texts and forms: the state has a `panel`. */
  readonly panels?: boolean;
  /** It calibrates again and shifts trackers when ordered: the state has `calibration`. */
  readonly calibrates?: boolean;
}

export interface Hooks {
  /** Called before anything is sent; a returned failure ends the connection. */
  readonly onWelcome: (welcome: Welcome) => Promise<Failure | null>;
  readonly onState: (state: HeadsetState) => void;
  readonly onNotice: (notice: Notice) => void;
  /** Connected, disconnected, or failed for good. */
  readonly onChange: () => void;
}

export interface ConnectionParts extends Omit<Parts, "onFailure"> {
  readonly address: Address;
  /** The client's name. */
  readonly name: string;
  /** Whether the client sends the streams of fingers. */
  readonly fingers?: boolean;
  readonly abilities?: Abilities;
  readonly makeSocket: MakeSocket;
  readonly hooks: Hooks;
}

export class Connection {
  failure: Failure | null = null;
  /** The number that the server gave to this run; null before the first welcome. */
  epoch: number | null = null;
  readonly #parts: ConnectionParts;
  #channel: Channel | null = null;
  #conversation: Conversation | null = null;
  #isClosed = false;
  #endPause: () => void = () => undefined;

  constructor(parts: ConnectionParts) {
    this.#parts = parts;
  }

  get isConnected(): boolean {
    return this.#conversation !== null;
  }

  /** Keep the connection up until it is closed or has failed. */
  async run(): Promise<void> {
    const { retryS } = this.#parts.limits;
    let attempt = 0;
    while (this.#goesOn) {
      // A connection that got as far as the welcome restarts the waiting times.
      attempt = (await this.#connectOnce()) ? 0 : attempt;
      if (this.#goesOn) await this.#pause(retryS[Math.min(attempt, retryS.length - 1)] ?? 1);
      attempt++;
    }
  }

  /**
   * Announce how far this run has come, and disconnect. What is not acknowledged stays in the
   * journal.
   */
  close(): void {
    this.#isClosed = true;
    this.#conversation?.announcer.announce();
    this.#channel?.close(1000);
    this.#endPause();
  }

  get #goesOn(): boolean {
    return !this.#isClosed && this.failure === null;
  }

  /** Open one connection and wait for its end; return whether it was welcomed. */
  async #connectOnce(): Promise<boolean> {
    const { address, limits, makeSocket } = this.#parts;
    let channel: Channel;
    try {
      channel = new Channel(
        address,
        limits,
        makeSocket,
        () => channel.send(this.#hello),
        (text) => this.#receive(channel, text),
      );
    } catch (error) {
      this.#fail({ code: "address", message: String(error), remedy: "Check address and token." });
      return false;
    }
    this.#channel = channel;
    const ending = await channel.ended;
    const conversation = this.#conversation;
    this.#conversation = null;
    this.failure ??= finalFailure(ending);
    // Immediately: a running phase has to stop its clock.
    this.#parts.hooks.onChange();
    await conversation?.stop();
    return conversation !== null;
  }

  get #hello(): string {
    const { name, fingers = false, abilities = {} } = this.#parts;
    const { avatars, changesAvatar, goals, panels, calibrates } = abilities;
    return textOf({
      type: "hello",
      protocol: PROTOCOL_VERSION,
      client: name,
      epoch: this.epoch,
      // A server of an older version does not know these fields.
      ...(fingers && { fingers }),
      ...(avatars && { avatars: [...avatars] }),
      ...(changesAvatar && { changes_avatar: true }),
      ...(goals && { goals }),
      ...(panels && { panels }),
      ...(calibrates && { calibrates }),
    });
  }

  #receive(channel: Channel, text: string): void {
    // Read first, because it is part of a clock reading.
    const receivedS = this.#parts.clock();
    let message: ServerMessage | null;
    try {
      message = serverMessage(text);
    } catch (error) {
      this.#fail({
        code: "not_understood",
        message: `the server said something that this page does not understand: ${error}`,
        remedy: "Reload this page; page and server must be of the same version.",
      });
      return;
    }
    if (message?.type === "welcome") void this.#welcomed(channel, message);
    else if (message !== null) this.#follow(message, receivedS);
  }

  #follow(message: Exclude<ServerMessage, Welcome>, receivedS: number): void {
    const { hooks, journal } = this.#parts;
    switch (message.type) {
      case "ack":
        journal.acknowledge(message.positions);
        break;
      case "state":
        hooks.onState(message);
        break;
      case "resend":
        this.#conversation?.resend(message);
        break;
      case "probe":
        this.#conversation?.prober.take(message, receivedS);
        break;
      case "error":
        this.#fail(message);
        break;
      default:
        hooks.onNotice(message);
    }
  }

  async #welcomed(channel: Channel, welcome: Welcome): Promise<void> {
    const refusal = await this.#parts.hooks.onWelcome(welcome).catch(browserFailed);
    if (refusal !== null) this.#fail(refusal);
    if (!channel.isOpen || this.#conversation !== null) return;
    this.epoch ??= welcome.epoch;
    // First the state, then the positions that it includes, as always: `settled` means both.
    this.#parts.hooks.onState(welcome.state);
    this.#parts.journal.acknowledge(welcome.positions);
    this.#conversation = new Conversation(channel, {
      ...this.#parts,
      onFailure: (failure) => this.#fail(failure),
    });
    this.#parts.hooks.onChange();
  }

  #fail({ code, message, remedy }: Failure): void {
    this.failure ??= { code, message, remedy };
    // The server closes after an `error`; if the failure is the client's, the client closes first.
    this.#channel?.close(4000, code);
    this.#parts.hooks.onChange();
  }

  async #pause(seconds: number): Promise<void> {
    await new Promise<void>((resolve) => {
      const timer = setTimeout(resolve, seconds * 1000);
      this.#endPause = () => {
        clearTimeout(timer);
        resolve();
      };
    });
  }
}

const browserFailed = (error: unknown): Failure => ({
  code: "browser",
  message: `the browser could not prepare its journal: ${error}`,
  remedy: "Reload this page.",
});

/** Codes that the next attempt would meet again, and what to do about them. */
const FINAL: Readonly<Record<number, string>> = {
  1009: "A message is larger than the server takes. Send fewer frames in a batch.",
  4400: "Reload this page; page and server must be of the same version.",
  4401: "Pair this headset again.",
  4403: "Open this page at the address of the server.",
};

function finalFailure({ code, reason }: Ending): Failure | null {
  const remedy = FINAL[code];
  if (remedy === undefined) return null;
  return { code: `closed_${code}`, message: reason || `the server closed with ${code}`, remedy };
}
