import type { Place } from "@shared/avatar/hips";
import { length, minus, type Quaternion, type Vector } from "@shared/rotations";
import { afterEach, describe, expect, it } from "vitest";
import type { EmulatedOptions } from "../../testing/emulatedHeadset";
import { type SessionInNode, sessionInNode } from "../../testing/inNode";
import type { DeviceKey } from "../devices";
import { GESTURES, gestureRotations, handJoints } from "../handShape";
import { composed, onFloor, turned } from "../places";
import type { TrackedFrame } from "../tracked";
import { Room } from "./room";
import { XrSource } from "./source";
import { WebXrTracking } from "./tracking";

const at = (x: number, y: number, z: number, rotation: Quaternion = [1, 0, 0, 0]): Place => ({
  positionM: [x, y, z],
  rotation,
});
const near = (place: Place | null | undefined, wanted: Place, byM = 1e-5): void => {
  expect(place).not.toBeNull();
  if (place === null || place === undefined) return;
  expect(length(minus(place.positionM, wanted.positionM))).toBeLessThan(byM);
  const dot = place.rotation.reduce(
    (sum, one, axis) => sum + one * (wanted.rotation[axis] as number),
    0,
  );
  expect(Math.abs(dot)).toBeGreaterThan(1 - 1e-6);
};
const ASLANT = turned([0.6, 0, 0.8], 0.9);

let open: SessionInNode | null = null;
afterEach(() => {
  open?.close();
  open = null;
});

async function worn(options: EmulatedOptions = {}, device: DeviceKey = "quest") {
  const session = await sessionInNode(options);
  open = session;
  const resets: boolean[] = [];
  const room = new Room(session.floor, {
    onSpace: () => undefined,
    onReset: (isKept) => resets.push(isKept),
  });
  const source = new XrSource(session.session, room, device);
  const read = (): TrackedFrame => session.frame((timeS, frame) => source.read(timeS, frame));
  return { ...session, room, source, read, resets };
}

describe("A headset in WebXR", () => {
  it("reads eyes, controllers and their buttons in the room's frame", async () => {
    const { headset, read, source, clock } = await worn();
    headset.setEyes(at(0.1, 1.62, -0.2, ASLANT));
    headset.setController("left", at(-0.3, 1.1, -0.4, ASLANT));
    headset.setController("right", at(0.3, 1.0, -0.35));
    headset.press("right", "select", true);
    headset.press("left", "squeeze", true);
    read();
    const seen = read();
    expect(seen.timeS).toBeCloseTo(clock.nowMs / 1000, 9);
    near(seen.eyes, at(0.1, 1.62, -0.2, ASLANT));
    near(seen.parts.LeftHand.place, at(-0.3, 1.1, -0.4, ASLANT));
    expect(seen.parts.RightHand).toMatchObject({ state: "tracked", device: "controller" });
    expect(seen.parts.LeftLowerLeg).toEqual({ place: null, state: "lost", device: null });
    expect(seen.parts.Hips.state).toBe("lost");
    expect([
      seen.hands.right.isSelecting,
      seen.hands.left.isSqueezing,
      seen.hands.left.isSelecting,
    ]).toEqual([true, true, false]);
    expect(length(seen.hands.left.ray?.direction ?? [0, 0, 0])).toBeCloseTo(1, 6);
    expect([source.kind, [...source.measures].length]).toEqual(["controllers", 3]);
  });

  it("goes over to tracked hands when controllers are put down, with fingers, pinch and fist", async () => {
    const { headset, read, source } = await worn();
    headset.setEyes(at(0, 1.6, 0));
    read();
    headset.useHands(true);
    for (const side of ["left", "right"] as const) {
      const fingers = gestureRotations(side, side === "left" ? GESTURES.pinch : GESTURES.fist);
      headset.setHand(side, handJoints(side, at(0.2, 1.2, -0.3, ASLANT), fingers, 0.19));
    }
    read();
    const { parts, hands } = read();
    expect(source.kind).toBe("hands");
    near(parts.LeftHand.place, at(0.2, 1.2, -0.3, ASLANT));
    expect(parts.LeftHand.device).toBe("hand");
    expect([hands.left.isSelecting, hands.left.isSqueezing, hands.right.isSqueezing]).toEqual([
      true,
      false,
      true,
    ]);
    const given = gestureRotations("left", GESTURES.pinch);
    expect(hands.left.fingers).toHaveLength(60);
    for (const [index, value] of (hands.left.fingers ?? []).entries()) {
      expect(value).toBeCloseTo(given[index] as number, 5);
    }
    expect(hands.left.holdsController).toBe(false);
  });

  it("gives no fingers of a hand of which a joint is lost, and nothing of one without a wrist", async () => {
    const { headset, read } = await worn();
    headset.useHands(true);
    const whole = handJoints("left", at(0, 1, 0), gestureRotations("left", GESTURES.flat), 0.19);
    headset.setHand("left", new Map([...whole].filter(([name]) => name !== "thumb-metacarpal")));
    headset.setHand("right", new Map([...whole].filter(([name]) => name !== "wrist")));
    read();
    const { parts, hands } = read();
    expect([parts.LeftHand.state, hands.left.fingers]).toEqual(["tracked", null]);
    expect([parts.RightHand.state, hands.right.fingers, hands.right.isSelecting]).toEqual([
      "lost",
      null,
      false,
    ]);
  });

  it("calls what is lost lost, and finds it again", async () => {
    const { headset, read } = await worn();
    headset.setEyes(at(0, 1.6, 0));
    headset.setController("left", at(0, 1, 0));
    headset.setLost("controller left", true);
    headset.setLost("eyes", true);
    read();
    const lost = read();
    expect([
      lost.eyes,
      lost.parts.Head.state,
      lost.parts.LeftHand.state,
      lost.parts.RightHand.state,
    ]).toEqual([null, "lost", "lost", "tracked"]);
    headset.setLost("controller left", false);
    headset.setLost("eyes", false);
    expect(read().parts.LeftHand.state).toBe("tracked");
  });

  it("takes legs of a Quest's body for inferred and a PICO's for tracked, whatever joints there are", async () => {
    for (const [device, legs] of [
      ["quest", "inferred"],
      ["pico", "tracked"],
      ["other", "inferred"],
    ] as const) {
      const { headset, read, source, close } = await worn({ bodyTracking: true }, device);
      headset.setEyes(at(0, 1.6, 0));
      expect(read().parts.LeftLowerLeg.state).toBe("lost");
      headset.setBodyJoint("left-lower-leg", at(-0.1, 0.48, 0.02, ASLANT));
      headset.setBodyJoint("right-lower-leg", at(0.1, 0.48, 0.02));
      headset.setBodyJoint("left-hand-wrist", at(-0.5, 1, 0));
      headset.setBodyJoint("a-joint-that-nobody-knows", at(9, 9, 9));
      const { parts } = read();
      near(parts.LeftLowerLeg.place, at(-0.1, 0.48, 0.02, ASLANT));
      expect([parts.LeftLowerLeg.state, parts.LeftLowerLeg.device]).toEqual([legs, "body"]);
      expect([parts.Hips.state, parts.LeftHand.device]).toEqual(["inferred", "controller"]);
      expect([source.kind, source.measures.has("LeftLowerLeg")]).toEqual([
        "body_tracking",
        legs === "tracked",
      ]);
      headset.setBodyJoint("right-lower-leg", null);
      expect([read().parts.RightLowerLeg.state, source.kind]).toEqual(["lost", "controllers"]);
      headset.showBody(false);
      expect(read().parts.LeftLowerLeg.state).toBe("lost");
      close();
      open = null;
    }
  });

  it("reads controllers on the shins beside tracked hands, and one that is lost", async () => {
    const { headset, read, source } = await worn({ trackedSources: true, bodyTracking: true });
    headset.useHands(true);
    headset.setBodyJoint("left-lower-leg", at(5, 5, 5));
    headset.setBodyJoint("right-lower-leg", at(5, 5, 5));
    headset.setTrackedSource("left", at(-0.1, 0.4, 0, ASLANT));
    headset.setTrackedSource("right", at(0.1, 0.4, 0));
    read();
    const { parts } = read();
    near(parts.LeftLowerLeg.place, at(-0.1, 0.4, 0, ASLANT));
    expect([source.kind, parts.LeftLowerLeg.state, parts.LeftLowerLeg.device]).toEqual([
      "shin_controllers",
      "tracked",
      "tracker",
    ]);
    expect(source.measures.has("RightLowerLeg")).toBe(true);
    headset.setLost("tracked right", true);
    headset.showBody(false);
    expect([read().parts.RightLowerLeg.state, source.kind]).toEqual(["lost", "shin_controllers"]);
    source.allow(["hands"]);
    expect([read().parts.LeftLowerLeg.state, source.kind]).toEqual(["lost", "hands"]);
    expect(() => source.allow(["body_tracking"])).toThrow(/controllers or hands/);
  });
});

describe("The room", () => {
  const square = onFloor(1.2, -0.7, 0.8);
  const stood: Vector = [0.3, 1.6, -0.1];

  it("has its origin on the square where the participant stands, facing -z", async () => {
    const { headset, read, room } = await worn();
    headset.setEyes(composed(square, at(0, 1.6, 0)));
    near(read().eyes, composed(square, at(0, 1.6, 0)));
    room.recentreAt(read().eyes as Place);
    near(room.roomFromSquare, square);
    near(read().eyes, at(0, 1.6, 0));
    headset.setEyes(composed(square, at(...stood, turned([0, 1, 0], 0.5))));
    room.recentreAt(read().eyes as Place, { heading: false });
    near(read().eyes, at(0, 1.6, 0, turned([0, 1, 0], 0.5)));
  });

  it("keeps the square where it is when the wearer recentres, and says so", async () => {
    const { headset, read, room, resets } = await worn();
    room.placeSquare(square);
    headset.setEyes(composed(square, at(...stood)));
    near(read().eyes, at(...stood));
    // The device's own origin moves; what is given to the emulation stays in the room as it is.
    headset.recentre(onFloor(-2, 1, -1.1));
    near(read().eyes, at(...stood));
    headset.recentre(onFloor(0.4, 0, 2));
    near(read().eyes, at(...stood));
    expect(resets).toEqual([true, true]);
  });

  it("asks for a new calibration if the device does not say where its origin went", async () => {
    const { floor, resets, read } = await worn();
    read();
    floor.dispatchEvent(Object.assign(new Event("reset"), { referenceSpace: floor }));
    expect(resets).toEqual([false]);
  });

  it("is the same in the next session of the page", async () => {
    const { session, floor, headset, frame } = await worn();
    const spaces: XRReferenceSpace[] = [];
    const tracking = new WebXrTracking({ onSpace: (space) => spaces.push(space) }, "Quest 3");
    expect(tracking.read(0, null).eyes).toBeNull();
    tracking.begin(session, floor);
    tracking.room?.placeSquare(square);
    tracking.begin(session, floor);
    expect(spaces).toHaveLength(2);
    headset.setEyes(composed(square, at(...stood)));
    near(frame((timeS, xr) => tracking.read(timeS, xr)).eyes, at(...stood));
    tracking.dispose();
    expect(frame((timeS, xr) => tracking.read(timeS, xr)).eyes).toBeNull();
  });
});
