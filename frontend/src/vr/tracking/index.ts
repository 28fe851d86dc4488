export { CaptureSource, type Recording, RecordingError } from "./capture/source";
export { DESKTOP_ACTIONS, DESKTOP_KEYS, type DesktopAction } from "./desktop/controls";
export { DesktopSource } from "./desktop/source";
export {
  DEVICE_PROFILES,
  type DeviceKey,
  deviceKeyOf,
  type Legs,
  legsOfBodyTracking,
  type TrackingWay,
  waysForFeet,
} from "./devices";
export { TrackerLink } from "./server/link";
export { ServerTrackers } from "./server/trackers";
export { SteadyGoals } from "./steady";
export type {
  GoalPart,
  GoalState,
  HandInput,
  KnownBody,
  SourceKind,
  TrackedFrame,
  TrackedPart,
  TrackingDevice,
  TrackingSource,
} from "./tracked";
export { Boundary } from "./webxr/boundary";
export { Room, type RoomListener } from "./webxr/room";
export { XR_WAYS, XrSource, type XrWay } from "./webxr/source";
export { WebXrTracking } from "./webxr/tracking";
