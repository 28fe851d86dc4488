/** Panels in the headset: texts, forms and prompts drawn in the scene, and how one stops. */
export * from "./care/calibrationPrompts";
export { PauseRoom } from "./care/pauseRoom";
export * from "./care/prompts";
export { looksRaised, StopGesture, type StopProgress } from "./care/stopGesture";
export { StopRing } from "./care/stopRing";
export { type PanelContent, StillContent } from "./content";
export { Questionnaire, type QuestionnaireOptions } from "./forms/questionnaire";
export { hasSpoken } from "./forms/questionScreens";
export { Panels } from "./panels";
export { pagesOfText, Reading, type ReadingOptions } from "./reading";
export type { PanelScreen } from "./surface/screen";
export type { Measure } from "./surface/wrap";
export { type PanelWords, panelWords } from "./texts";
