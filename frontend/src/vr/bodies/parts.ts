import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import type { BodiesSetup } from "./setup";

/** The parts whose touches are reported: the 22 joints and, with fingers, their 30 parts. */
export const partsOf = ({ withFingers }: BodiesSetup): readonly string[] =>
  withFingers ? [...JOINTS, ...FINGER_PARTS] : JOINTS;
