/** The test of the headset that runs it: its two minutes, what they measure, and the report. */
export { type Delivered, Outbox, type Send, sendWith } from "./outbox";
export type { Report, SelfTestView, Verdict } from "./report";
export { type Progress, summaryText } from "./screens";
export { SelfTest, type SelfTestInspection, type SelfTestParts } from "./selfTest";
export { type SelfTestKey, selfTestDe, selfTestEn } from "./texts";
