/** What the participant sees: the room, its mirror, bodies and boxes. Imports three.js. */
export { type Palette, paletteOf, STANDARD } from "./appearance";
export { type BoundaryProblem, edgeDistanceM, type FloorPoint } from "./boundary";
export { PANELS_ORDER } from "./curtain";
export type { Device, DeviceKind } from "./devices";
export { BodyEyes } from "./eyes";
export type { Setup, TaskShown } from "./setups";
export { type Sound, Sounds } from "./sounds";
export { type BodyValues, type Visible, World, type WorldFrame, type WorldOptions } from "./world";
