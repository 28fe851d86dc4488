/** What was done to the bodies while their curves were drawn. */
import type { Command } from "./physics/commands";
import { strengthOf } from "./pulling";

export type MarkKind = "push" | "pull" | "drop" | "latency" | "gravity" | "reset" | "change";

export interface Mark {
  readonly id: number;
  readonly kind: MarkKind;
  /** Ticks that the curves had before it. */
  readonly tick: number;
  /** N of a push, ms of a latency, 1 or 0 of gravity; else null. */
  readonly value: number | null;
}

type Done = Pick<Mark, "kind" | "value">;

/** A number that is being typed is one change, not one for each digit. */
const SAME_TICKS = 50;

/** Keeps the marks of the window. */
export class Marks {
  private list: readonly Mark[] = [];
  private count = 0;
  private latencyMs = 0;
  private hasGravity: boolean | null = null;
  private isPulled = false;

  /** Note a command that was given after a number of ticks; the curves before it may be empty. */
  note(command: Command, tick: number): void {
    const isNew = this.read(command);
    if (isNew !== null && tick > 0) this.add({ ...isNew, tick });
  }

  add(given: Omit<Mark, "id">): void {
    const mark = { id: ++this.count, ...given };
    const last = this.list.at(-1);
    const isSame = last?.kind === mark.kind && mark.tick - last.tick < SAME_TICKS;
    const replaces = isSame && (mark.kind === "latency" || mark.kind === "change");
    this.list = [...(replaces ? this.list.slice(0, -1) : this.list), mark];
  }

  /** Those since a tick, oldest first. */
  since(tick: number): readonly Mark[] {
    return this.list.filter((mark) => mark.tick >= tick);
  }

  forgetBefore(tick: number): void {
    if (this.list.some((mark) => mark.tick < tick)) this.list = this.since(tick);
  }

  forget(): void {
    this.list = [];
  }

  private read(command: Command): Done | null {
    const { kind } = command;
    if (kind === "drop") return { kind, value: null };
    if (kind === "reset") {
      this.isPulled = false;
      return { kind, value: null };
    }
    if (kind === "latency") {
      const value = Math.round(1000 * command.latencyS);
      if (value === this.latencyMs) return null;
      this.latencyMs = value;
      return { kind, value };
    }
    if (kind === "gravity") {
      const before = this.hasGravity;
      this.hasGravity = command.isOn;
      return before === null || before === command.isOn ? null : { kind, value: +command.isOn };
    }
    return kind === "push" ? this.readPush(command) : null;
  }

  private readPush({ push }: Extract<Command, { kind: "push" }>): Done | null {
    const wasPulled = this.isPulled;
    this.isPulled = push !== null && push.forS === null;
    if (push === null || (this.isPulled && wasPulled)) return null;
    if (this.isPulled) return { kind: "pull", value: null };
    return { kind: "push", value: Math.round(strengthOf(push.forceN)) };
  }
}
