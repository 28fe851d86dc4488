/** The participant's two bodies: posed from what is tracked, and simulated (docs/avatar.md). */
export {
  type Bodies,
  type BodiesFrame,
  type BodiesInput,
  CannotChange,
  type PoseValues,
} from "./bodies";
export { openBodiesInPage } from "./inPage";
export { type BodiesInWorker, fetchBodiesBeforehand, openBodiesInWorker } from "./inWorker";
export type { AvatarAnswer, BodiesSetup, SurfaceBox } from "./setup";
