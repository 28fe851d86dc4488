/** What a client does on a connection that was welcomed: send the journal, probe, announce. */
import type { Failure } from "../failure";
import type { Journal } from "../journal/journal";
import { JournalLost } from "../journal/reader";
import type { Limits } from "../limits";
import type { StreamPosition } from "../wire/fromServer";
import { Announcer } from "./announcer";
import type { Channel } from "./channel";
import { Prober } from "./clockProbe";

export interface Parts {
  readonly journal: Journal;
  readonly limits: Limits;
  /** The client's monotonic clock, s. */
  readonly clock: () => number;
  readonly onFailure: (failure: Failure) => void;
}

export class Conversation {
  readonly prober: Prober;
  readonly announcer: Announcer;
  readonly #channel: Channel;
  readonly #parts: Parts;
  readonly #sending: Promise<void>;
  #hole: { readonly position: StreamPosition; attempts: number; atS: number } | null = null;

  constructor(channel: Channel, parts: Parts) {
    const send = (text: string) => channel.send(text);
    this.#channel = channel;
    this.#parts = parts;
    parts.journal.reader.rewind();
    this.announcer = new Announcer(send, parts.journal, parts.limits);
    this.prober = new Prober(send, parts.clock, parts.limits);
    this.#sending = this.#sendJournal();
  }

  /**
   * The server expected an earlier seq: go back to it. Every message that is under way behind the
   * gap gets the same answer, and only the first one is acted on.
   */
  resend(position: StreamPosition): void {
    const { clock, journal, limits, onFailure } = this.#parts;
    const isSame =
      this.#hole?.position.stream === position.stream &&
      this.#hole.position.epoch === position.epoch &&
      this.#hole.position.next_seq === position.next_seq;
    if (this.#hole === null || !isSame) this.#hole = { position, attempts: 0, atS: -Infinity };
    if (clock() - this.#hole.atS < limits.resendPauseS) return;
    this.#hole.atS = clock();
    this.#hole.attempts++;
    if (this.#hole.attempts > limits.resendAttempts) onFailure(lostOnTheServer(position));
    else journal.reader.rewind();
  }

  /** Stop everything; call this after the channel has ended. */
  async stop(): Promise<void> {
    this.prober.stop();
    this.announcer.stop();
    this.#parts.journal.reader.wake();
    await this.#sending;
  }

  /** The only sender of journaled messages, so they go out in order and none is skipped. */
  async #sendJournal(): Promise<void> {
    while (this.#channel.isOpen) {
      try {
        await this.#sendNext();
      } catch (error) {
        if (error instanceof JournalLost) this.#parts.onFailure(lostInBrowser(error));
        // A disk that cannot be read now may be readable in a moment.
        else await new Promise((resolve) => setTimeout(resolve, READ_RETRY_MS));
      }
    }
  }

  async #sendNext(): Promise<void> {
    const { reader } = this.#parts.journal;
    const entry = await reader.next();
    if (entry !== null) {
      await this.#channel.room();
      this.#channel.send(entry.message);
    } else if (this.#channel.isOpen) await reader.moreToSend();
  }
}

const READ_RETRY_MS = 500;

const lostInBrowser = ({ message }: JournalLost): Failure => ({
  code: "journal_lost",
  message,
  remedy: "Note the time in the session's record and reload this page; it continues as a new run.",
});

const lostOnTheServer = ({ stream, epoch, next_seq }: StreamPosition): Failure => ({
  code: "lost_on_the_server",
  message: `the server asks for ${stream} of run ${epoch} from ${next_seq} on, which it had confirmed`,
  remedy: "Was an older copy of its data restored? Reload this page; it continues as a new run.",
});
