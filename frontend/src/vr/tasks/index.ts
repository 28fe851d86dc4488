/** The box tasks in the headset: layouts, contacts, rules, views, and the phases that run them. */
export { CapsuleContacts, RELEASE_MARGIN_M, type Touches } from "./contacts";
export type { Laterality, Limb, Side, Surface, SurfaceKind, TaskLayout } from "./layout";
export { BoxRun } from "./phases/boxRun";
export { type PhaseSurroundings, Phases } from "./phases/phases";
export { RoadRun } from "./phases/roadRun";
export { FreeRun, TimedRun } from "./phases/timedRun";
export { type TaskEvent, TaskRules, type TaskState } from "./state";
export { layoutsOf } from "./studyTasks";
export { type Colour, currentGoal, displayedNumbers, surfaceColours } from "./views";
