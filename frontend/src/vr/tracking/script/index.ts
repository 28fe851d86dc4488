export { NO_OFFSETS, WornDevices, type WornOptions } from "./devices";
export { type GoalSurface, goalOn, marchingStep } from "./goals";
export type { ScriptedGoal, Traits } from "./movements";
export { type ArmPose, type PersonOptions, type PersonSide, ScriptedPerson } from "./person";
export { ScriptSource, type ScriptSourceOptions } from "./source";
