import { describe, expect, it } from "vitest";
import type { Shape } from "./physics/shapes";
import {
  driveCommand,
  dropCommand,
  FIRST_PUSH,
  firstDrive,
  poseCommand,
  pushCommand,
  withKind,
} from "./settings";

const shape = (part: string, body: number, y: number): Shape => ({
  body,
  part,
  kind: "sphere",
  sizeM: [0.1, 0, 0],
  positionM: [0, y, 0],
  rotation: [1, 0, 0, 0],
  cornersM: new Float32Array(0),
  collides: true,
});
const SHAPES = [
  shape("Hips", 1, 0),
  shape("LeftLowerLeg", 2, -0.1),
  shape("LeftLowerLeg", 2, -0.3),
];

describe("what is chosen becomes a command", () => {
  it("holds the angle nearest to zero first, and swings about the middle of the limits", () => {
    const limits = { lowDeg: 10.4, highDeg: 90 };
    const first = firstDrive(limits);
    expect(first).toMatchObject({ kind: "hold", angleDeg: 11, amplitudeDeg: 20 });
    const swings = withKind(first, "sine", limits);
    expect(swings.angleDeg).toBe(50);
    expect(withKind(swings, "step", limits).angleDeg).toBe(50);
    expect(driveCommand("NeckX", { ...swings, angleDeg: 180 })).toEqual({
      kind: "drive",
      drive: {
        axis: "NeckX",
        wave: { kind: "sine", centerRad: Math.PI, amplitudeRad: Math.PI / 9, periodS: 2 },
      },
    });
  });

  it("pushes a part at its centre of mass, poses the others, and drops a box from above", () => {
    expect(pushCommand(FIRST_PUSH)).toEqual({
      kind: "push",
      push: { part: "LeftLowerLeg", pointM: null, forceN: [0, 0, 100], forS: 0.2 },
    });
    expect(poseCommand("leg")).toEqual({
      kind: "pose",
      anglesRad: { LeftUpperLegX: Math.PI / 6, LeftLowerLegX: (50 * Math.PI) / 180 },
    });
    const places = new Float32Array(21).fill(0.25);
    expect(dropCommand("LeftLowerLeg", SHAPES, places)).toEqual({
      kind: "drop",
      centerM: [0.25, 0.85, 0.25],
    });
  });
});
