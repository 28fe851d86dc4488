/** The session in the headset: everything between the button Enter and the end of the visit. */
export { loadModel, type SessionAvatar } from "./avatars";
export { drawIn, requestImmersive } from "./immersive";
export type { Granted } from "./inspection";
export { Recorder, type Sink } from "./recorder";
export { Vr, type VrParts } from "./vr";
