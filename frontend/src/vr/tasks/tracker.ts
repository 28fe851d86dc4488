/**
 * Turns the touches of each frame into contact intervals, the unit that is stored: the server's
 * `app/science/tasks/tracker.py`.
 *
 * A part on a surface gives one interval, from when the contact begins to count until it no longer
 * does. A pause closes every open interval; a contact that still exists when the clock resumes begins
 * a new one at that instant.
 */
import type { Touches } from "./contacts";
import { type Contact, type ContactChange, type Contacts, isActive, type TaskState } from "./state";

/** An interval in which a part counted as touching a surface, on both clocks. */
export interface ContactInterval extends Contact {
  readonly beginS: number;
  readonly endS: number;
  readonly beginActiveS: number;
  readonly endActiveS: number;
}

interface Begin extends Contact {
  readonly timeS: number;
  readonly activeS: number;
}

const NOTHING: Contacts = new Map();

/**
 * Tracks the contacts of a phase. Each frame: `observe`, then `advance` with the change (if there is
 * one), then `settle`; after a command only `settle`. A frame takes effect with its `settle`, so one
 * that the rules reject leaves no trace.
 */
export class ContactTracker {
  #touching: Uint8Array;
  #next: Uint8Array;
  #hasNext = false;
  #wasActive = false;
  readonly #open = new Map<string, Begin>();

  constructor(
    private readonly surfaces: readonly string[],
    private readonly parts: readonly string[],
  ) {
    this.#touching = new Uint8Array(surfaces.length * parts.length);
    this.#next = new Uint8Array(surfaces.length * parts.length);
  }

  /** The contacts that begin and end with this frame; null if nothing changes. */
  observe(timeS: number, { touched, near }: Touches): ContactChange | null {
    const was = this.#touching;
    if (touched.length !== was.length || near.length !== was.length) {
      throw new RangeError(
        `Expected touches of ${this.surfaces.length} surfaces by ${this.parts.length} parts, ` +
          `got ${touched.length} and ${near.length} values.`,
      );
    }
    let hasChanged = false;
    for (let at = 0; at < was.length; at++) {
      const now = touched[at] || (was[at] && near[at]) ? 1 : 0;
      this.#next[at] = now;
      if (now !== was[at]) hasChanged = true;
    }
    if (!hasChanged) return null;
    this.#hasNext = true;
    return { timeS, begins: this.#contacts(1), ends: this.#contacts(0) };
  }

  /** Open and close intervals to match the state after an input; returns those that closed. */
  settle(state: TaskState): readonly ContactInterval[] {
    if (this.#hasNext) {
      [this.#touching, this.#next] = [this.#next, this.#touching];
      this.#hasNext = false;
    }
    const timeS = state.lastS;
    const counts = isActive(state) ? state.contacts : NOTHING;
    // The touch that stopped the clock counted, so its interval is opened before all are closed.
    const touched = this.#wasActive ? state.contacts : counts;
    for (const [name, contact] of touched) {
      if (this.#open.has(name)) continue;
      this.#open.set(name, { ...contact, timeS, activeS: state.clock.activeS(timeS) });
    }
    this.#wasActive = isActive(state);
    const closing = [...this.#open.keys()].filter((name) => !counts.has(name)).sort();
    return closing.map((name) => this.#close(name, state));
  }

  #close(name: string, state: TaskState): ContactInterval {
    const { surface, part, timeS, activeS } = this.#open.get(name) as Begin;
    this.#open.delete(name);
    return {
      surface,
      part,
      beginS: timeS,
      endS: state.lastS,
      beginActiveS: activeS,
      endActiveS: state.clock.activeS(state.lastS),
    };
  }

  /** The contacts that change to this value (1: begin, 0: end) with the next frame. */
  #contacts(value: 0 | 1): readonly Contact[] {
    const found: Contact[] = [];
    this.#next.forEach((now, at) => {
      if (now !== value || now === this.#touching[at]) return;
      found.push({
        surface: this.surfaces[Math.floor(at / this.parts.length)] as string,
        part: this.parts[at % this.parts.length] as string,
      });
    });
    return found;
  }
}
