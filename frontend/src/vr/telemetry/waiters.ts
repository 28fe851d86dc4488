/** Those who wait until something holds. */
import { type Failure, TelemetryError } from "./failure";

interface Waiter {
  readonly isDone: () => boolean;
  readonly resolve: () => void;
  readonly reject: (error: TelemetryError) => void;
}

export class Waiters {
  #waiting: readonly Waiter[] = [];

  async until(isDone: () => boolean): Promise<void> {
    if (isDone()) return;
    await new Promise<void>((resolve, reject) => {
      this.#waiting = [...this.#waiting, { isDone, resolve, reject }];
    });
  }

  /** Something has changed. With a failure nothing will come of the waiting any more. */
  look(failure: Failure | null): void {
    const over = this.#waiting.filter((one) => failure !== null || one.isDone());
    if (over.length === 0) return;
    this.#waiting = this.#waiting.filter((one) => !over.includes(one));
    for (const one of over) {
      if (one.isDone() || failure === null) one.resolve();
      else one.reject(new TelemetryError(failure));
    }
  }
}
