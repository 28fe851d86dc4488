import { length, minus, type Quaternion, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { turned } from "../places";
import { ScriptedPerson } from "../script";
import { INDEX, JOINTS } from "../skeleton";
import { CaptureSource, type Recording, RecordingError } from "./source";

const RATE_HZ = 30;
const AROUND: Quaternion = turned([0, 1, 0], 2.1);

/** A recording of a scripted person of 1.6 m who steps forwards, elsewhere and turned away. */
function recorded(seconds = 3): { recording: Recording; person: ScriptedPerson } {
  const person = new ScriptedPerson({ statureM: 1.6, seed: 2 });
  person.pursue({
    kind: "walk_to",
    limb: null,
    targetM: [0, 0, -0.6],
    nearM: 0.1,
    approachM: [0, 0.1, 0],
  });
  const names = ["Marker", ...JOINTS];
  const positions: number[] = [];
  const rotations: number[] = [];
  const frames = seconds * RATE_HZ;
  for (let frame = 0; frame < frames; frame++) {
    person.advance(frame / RATE_HZ);
    positions.push(0, 0, 0);
    rotations.push(0, 0, 0, 0);
    for (const joint of JOINTS.keys()) {
      const [x, y, z] = person.joints.positionsM[joint] as Vector;
      const [c, s] = [Math.cos(2.1), Math.sin(2.1)];
      positions.push(c * x + s * z + 5, y, c * z - s * x - 3);
      const local = person.local[joint] as Quaternion;
      // Of any length, as the server stores them.
      rotations.push(...(joint === 0 ? AROUND : local).map((one) => 2 * one));
    }
  }
  return { recording: { names, frames, rateHz: RATE_HZ, positions, rotations }, person };
}

describe("A recording as the participant", () => {
  it("begins on the square facing forwards, walks as recorded, in the participant's size", () => {
    const { recording } = recorded();
    const source = new CaptureSource(recording, 1.8);
    const first = source.read(10);
    const start = first.parts.Hips.place?.positionM as Vector;
    expect([start[0], start[2]]).toEqual([expect.closeTo(0, 6), expect.closeTo(0, 6)]);
    expect(first.parts.Hips.place?.rotation.map(Math.abs)).toEqual(
      [1, 0, 0, 0].map((one) => expect.closeTo(one, 6)),
    );
    expect(first.eyes?.positionM[1]).toBeGreaterThan(1.62);
    const later = source.read(10 + 2.4).parts.Hips.place?.positionM as Vector;
    expect(later[2]).toBeLessThan(-0.45 * (1.8 / 1.6));
    expect(Math.abs(later[0])).toBeLessThan(0.1);
    expect(source.knownBody.statureM).toBe(1.8);
  });

  it("goes on from its end to its beginning without a jump, as often as needed", () => {
    const { recording } = recorded();
    const source = new CaptureSource(recording, 1.6);
    let before: Vector | null = null;
    let fastest = 0;
    for (let frame = 0; frame < 8 * 90; frame++) {
      const hand = source.read(frame / 90).parts.LeftHand.place?.positionM as Vector;
      if (before !== null) fastest = Math.max(fastest, 90 * length(minus(hand, before)));
      before = hand;
    }
    expect(fastest).toBeLessThan(3);
  });

  it("refuses what does not hold the joints, and says which", () => {
    const { recording } = recorded(1);
    const names = recording.names.map((name) => (name === "LeftHand" ? "Wrist" : name));
    expect(() => new CaptureSource({ ...recording, names }, 1.7)).toThrow(/lacks LeftHand: choose/);
    const { rotations: _, ...bare } = recording;
    expect(() => new CaptureSource(bare, 1.7)).toThrow(RecordingError);
    expect(INDEX.Head).toBe(5);
  });
});
