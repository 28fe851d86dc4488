/** From devices to joints: the steps of the calibration, its result, and the goals of each frame. */
export {
  type Calibration,
  type Cause,
  calibrationFrom,
  calibrationReport,
  calibrationText,
  isMeasured,
  type Measures,
  type Notice,
  unmeasured,
} from "./calibration";
export { Calibrator, USUAL_STATURE_M } from "./calibrator";
export { CalibrationRun, MOST_ERROR_M, type RunOptions, type Tracks } from "./run";
export type { CalibrationProblem, CalibrationPrompt, CalibrationStep } from "./steps";
