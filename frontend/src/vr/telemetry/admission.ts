/** Makes producers wait while the journal has no room; first come, first served. */
import { type Failure, TelemetryError } from "./failure";
import type { Entry } from "./journal/entries";
import type { Journal } from "./journal/journal";

interface Call {
  readonly entry: Entry;
  readonly admitted: () => void;
  readonly refused: (error: TelemetryError) => void;
}

export class Admission {
  readonly #journal: Journal;
  #calls: Call[] = [];

  constructor(journal: Journal) {
    this.#journal = journal;
  }

  get waiting(): number {
    return this.#calls.length;
  }

  /** Resolves once the message is in the journal. */
  async enter(entry: Entry): Promise<void> {
    if (this.#calls.length === 0 && this.#journal.hasRoom) {
      this.#journal.add(entry);
      return;
    }
    await new Promise<void>((admitted, refused) => {
      this.#calls.push({ entry, admitted, refused });
    });
  }

  /** Admit the waiting messages that there is room for. */
  admit(): void {
    while (this.#journal.hasRoom) {
      const call = this.#calls.shift();
      if (call === undefined) return;
      this.#journal.add(call.entry);
      call.admitted();
    }
  }

  /** Reject all waiting and future messages. */
  refuseAll(failure: Failure): void {
    const calls = this.#calls;
    this.#calls = [];
    for (const call of calls) call.refused(new TelemetryError(failure));
  }
}
