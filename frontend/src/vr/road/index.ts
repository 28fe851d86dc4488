/** The study's road in the headset: its ground, its socket, who else is there. */
export { RoadGround } from "./ground";
export { type Others, RoadLink, type RoadLinkOptions } from "./link";
export type { Actor, FloorPlace } from "./wire";
