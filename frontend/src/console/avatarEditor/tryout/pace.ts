/** How fast a simulation goes by the clock on the wall, over the last second or two. */

const SPAN_S = 1;

export class Pace {
  /** Simulated time by the time that passed; null before a whole span. */
  value: number | null = null;
  private passedS = 0;
  private simulatedS = 0;

  /** Forget what was: time has not been counted for a while. */
  begin(): void {
    this.value = null;
    this.passedS = 0;
    this.simulatedS = 0;
  }

  simulated(spanS: number): void {
    this.simulatedS += spanS;
  }

  passed(spanS: number): void {
    this.passedS += spanS;
    if (this.passedS < SPAN_S) return;
    const now = this.simulatedS / this.passedS;
    // A single picture that came late is no slow machine.
    this.value = this.value === null ? now : (this.value + now) / 2;
    this.passedS = 0;
    this.simulatedS = 0;
  }
}
