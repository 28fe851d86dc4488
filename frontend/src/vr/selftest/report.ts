/** What a self-test measures and how it is judged, as the server describes both. */
import type { components } from "@shared/api/schema";
import type { GoalPart } from "../tracking/tracked";

type Schemas = components["schemas"];

export type { SelfTestView, Verdict } from "@shared/selfTest/verdict";

/** A report with every part named: what could not be measured is null. */
export type Report = Omit<Schemas["SelfTestReport"], "tracking" | "physics" | "storage"> & {
  readonly tracking: Readonly<Record<GoalPart, Schemas["GoalFigures"]>>;
  readonly physics: Schemas["PhysicsFigures"] | null;
  readonly storage: Schemas["StorageFigures"] | null;
};

/** Shorter ones say nothing about a device and are not reported, s. */
export const LEAST_DURATION_S = 10;

/** An id of 32 hexadecimal digits: a report that is sent twice is stored once. */
export const newReportId = (random: Crypto = crypto): string =>
  Array.from(random.getRandomValues(new Uint8Array(16)), (byte) =>
    byte.toString(16).padStart(2, "0"),
  ).join("");
