/** What a scripted person does when a calibration asks for a step. */
import type { CalibrationStep } from "../calibration/steps";
import type { ArmPose, ScriptedPerson } from "../tracking/script";

const ARMS: Readonly<Record<CalibrationStep, ArmPose>> = {
  square: "n_pose",
  n_pose: "n_pose",
  t_pose: "t_pose",
  squat: "n_pose",
  reach: "forward",
  mirror: "ease",
};
/** When somebody who is asked to squat goes down, and is up again. */
const DOWN_S = 0.4;
const UP_S = 2;

export class PromptedPerson {
  #step: CalibrationStep | null = null;
  #sinceS = 0;

  constructor(readonly person: ScriptedPerson) {}

  /** Do what is asked at this time; `bent`: how deep the knees are bent where they should not be. */
  follow(step: CalibrationStep, timeS: number, bent = 0): void {
    if (step !== this.#step) this.#sinceS = timeS;
    this.#step = step;
    this.person.take(ARMS[step]);
    const sinceS = timeS - this.#sinceS;
    const isDown = step === "squat" && sinceS > DOWN_S && sinceS < UP_S;
    this.person.squat = isDown ? 1 : bent;
  }

  /** Nothing is asked any more. */
  rest(): void {
    if (this.#step === null) return;
    this.#step = null;
    this.person.take("ease");
    this.person.squat = 0;
  }
}
