/**
 * The sounds, made of sine waves: a panel that counts, a completed task, the end of the time, and an
 * answer that was pressed. Nothing is loaded.
 */

export type Sound = "touch" | "complete" | "time_up" | "press";

interface Tone {
  readonly hertz: number;
  /** After the sound's beginning, s. */
  readonly atS: number;
  readonly lastsS: number;
}

const SOUNDS: Readonly<Record<Sound, readonly Tone[]>> = {
  press: [{ hertz: 880, atS: 0, lastsS: 0.05 }],
  touch: [{ hertz: 660, atS: 0, lastsS: 0.12 }],
  complete: [
    { hertz: 523.25, atS: 0, lastsS: 0.22 },
    { hertz: 659.25, atS: 0.09, lastsS: 0.22 },
    { hertz: 783.99, atS: 0.18, lastsS: 0.4 },
  ],
  time_up: [
    { hertz: 392, atS: 0, lastsS: 0.5 },
    { hertz: 293.66, atS: 0.22, lastsS: 0.8 },
  ],
};

const LOUDEST = 0.35;
/** A tone that begins at full loudness clicks, s. */
const RISE_S = 0.008;

export class Sounds {
  readonly #open: () => AudioContext;
  #context: AudioContext | null = null;
  #volume: number;

  /** `volume` from 0 (silent) to 1. */
  constructor(volume = 0.6, open: () => AudioContext = () => new AudioContext()) {
    this.#volume = volume;
    this.#open = open;
  }

  get volume(): number {
    return this.#volume;
  }

  set volume(volume: number) {
    this.#volume = Math.min(1, Math.max(0, volume));
  }

  /**
   * Call it in the click with which the participant enters: browsers let no page sound before. A
   * device without sound stays silent.
   */
  async resume(): Promise<void> {
    try {
      this.#context ??= this.#open();
      await this.#context.resume();
    } catch {
      this.#context = null;
    }
  }

  /** Play a sound now; silent before `resume`. */
  play(sound: Sound): void {
    const context = this.#context;
    if (context === null || context.state !== "running" || this.#volume === 0) return;
    for (const { hertz, atS, lastsS } of SOUNDS[sound]) {
      const start = context.currentTime + atS;
      const tone = new OscillatorNode(context, { type: "sine", frequency: hertz });
      const loudness = new GainNode(context, { gain: 0 });
      loudness.gain.setValueAtTime(0, start);
      loudness.gain.linearRampToValueAtTime(LOUDEST * this.#volume, start + RISE_S);
      loudness.gain.exponentialRampToValueAtTime(1e-4, start + lastsS);
      tone.connect(loudness).connect(context.destination);
      tone.start(start);
      tone.stop(start + lastsS);
    }
  }

  dispose(): void {
    const context = this.#context;
    this.#context = null;
    context?.close().catch(() => {});
  }
}
