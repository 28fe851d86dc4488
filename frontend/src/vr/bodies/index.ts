/** The participant's two bodies: posed from what is tracked, and simulated (docs/avatar.md). */
export type { Bodies, BodiesFrame, BodiesInput, PoseValues } from "./bodies";
export { openBodiesInPage } from "./inPage";
export type { AvatarAnswer, BodiesSetup, SurfaceBox } from "./setup";
