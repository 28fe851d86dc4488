export {
  NO_OFFSETS,
  usualOffsets,
  WornDevices,
  type WornOffsets,
  type WornOptions,
} from "./devices";
export { type GoalSurface, goalOn } from "./goals";
export type { ScriptedGoal, Traits } from "./movements";
export { type ArmPose, type PersonOptions, type PersonSide, ScriptedPerson } from "./person";
export { ScriptSource, type ScriptSourceOptions } from "./source";
