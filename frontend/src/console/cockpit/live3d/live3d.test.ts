import {
  decodeFingers,
  decodePose,
  openPoses,
  type PoseSetup,
  type PoseTouch,
} from "@shared/api/poses";
import { describe, expect, it, vi } from "vitest";
import { FULL_SCALE_DEG, heatColour } from "./heat";
import { makePlaced, place, restValues } from "./kinematics";
import { DARK, FLASH_MS, nextChange, tonesAt, withTouches } from "./lights";

const setup: PoseSetup = {
  type: "setup",
  blinded: false,
  simulated: false,
  recording: true,
  limb: "hand",
  stature_m: 1.7,
  stature_known: true,
  joints: ["Hips", "RightUpperArm", "RightHand"],
  parents: [-1, 0, 1],
  offsets_m: [
    [0, 1, 0],
    [0.25, 0.5, 0],
    [0.5, 0, 0],
  ],
  surfaces: [],
};

describe("placing a pose", () => {
  it("gives the rest pose if no joint is rotated", () => {
    const placed = makePlaced(3);
    place(setup, restValues(setup), placed);
    expect([...placed.positions]).toEqual([0, 1, 0, 0.25, 1.5, 0, 0.75, 1.5, 0]);
  });

  it("rotates everything below a joint, in the parent's frame", () => {
    const values = restValues(setup);
    const half = Math.SQRT1_2;
    // The hips a quarter turn to the left (about y), the arm a quarter turn upwards (about z).
    values.set([half, 0, half, 0], 3);
    values.set([half, 0, 0, half], 7);
    const placed = makePlaced(3);
    place(setup, values, placed);
    const expected = [0, 1, 0, 0, 1.5, -0.25, 0, 2, -0.25];
    expected.forEach((value, at) => {
      expect(placed.positions[at]).toBeCloseTo(value, 6);
    });
  });

  it("leaves unknown joints unknown, and all others where they are", () => {
    const values = restValues(setup);
    values[7] = Number.NaN;
    const placed = makePlaced(3);
    place(setup, values, placed);
    expect(placed.positions[3]).toBe(0.25);
    expect(placed.positions[6]).toBeNaN();
  });
});

const touch = (seq: number, effect: string, surface: string | null, phase = 1): PoseTouch => ({
  number: [1, seq],
  phase_id: phase,
  kind: surface === null ? "completion" : "panel",
  effect,
  surface,
  part: "RightHand",
});

describe("the boxes' lights", () => {
  const first = withTouches(DARK, [touch(0, "green", "hand/1/panel")], 0);

  it("stay on for a correctly touched panel, until the task is completed", () => {
    const later = withTouches(first, [touch(1, "green", "hand/2/panel")], 10_000);
    expect(tonesAt(later, 20_000)).toEqual(
      new Map([
        ["hand/1/panel", "good"],
        ["hand/2/panel", "good"],
      ]),
    );
    const done = withTouches(later, [touch(2, "completed", null)], 20_000);
    expect(tonesAt(done, 20_001).size).toBe(2);
    expect(tonesAt(done, 20_001 + FLASH_MS).size).toBe(0);
  });

  it("flash for a wall and report when they go out", () => {
    const hit = withTouches(first, [touch(1, "side", "hand/1/left")], 500);
    expect(tonesAt(hit, 501).get("hand/1/left")).toBe("bad");
    expect(nextChange(hit, 501)).toBe(500 + FLASH_MS);
    expect(tonesAt(hit, 501 + FLASH_MS)).toEqual(new Map([["hand/1/panel", "good"]]));
    expect(nextChange(hit, 501 + FLASH_MS)).toBeNull();
  });

  it("do not come on for touches that are repeated or long past", () => {
    const touches = [touch(0, "green", "hand/1/panel"), touch(1, "side", "hand/1/left")];
    expect(
      withTouches(withTouches(first, touches, 500), touches, 9000).lit.get("hand/1/left"),
    ).toEqual({
      tone: "bad",
      until: 500 + FLASH_MS,
    });
    expect([...tonesAt(withTouches(DARK, touches, 500), 500).keys()]).toEqual(["hand/1/panel"]);
  });

  it("start over with the next phase", () => {
    const next = withTouches(first, [touch(1, "green", "foot/1/panel", 2)], 500);
    expect([...tonesAt(next, 501).keys()]).toEqual(["foot/1/panel"]);
  });
});

describe("the heat map", () => {
  it("gets lighter with every degree up to its end", () => {
    const lightness = (degrees: number) => {
      const value = Number.parseInt(heatColour(degrees).slice(1), 16);
      return 0.3 * (value >> 16) + 0.59 * ((value >> 8) & 255) + 0.11 * (value & 255);
    };
    const steps = Array.from({ length: 13 }, (_, at) => lightness((at * FULL_SCALE_DEG) / 12));
    expect(steps).toEqual([...steps].sort((one, other) => one - other));
    expect(heatColour(400)).toBe(heatColour(FULL_SCALE_DEG));
    expect(heatColour(null)).toBe(heatColour(undefined));
  });
});

function message(stream: number): ArrayBuffer {
  const bytes = new ArrayBuffer(28 + 4 * 91);
  const view = new DataView(bytes);
  new Uint8Array(bytes).set([0x52, 0x4d, 0x50, 0x31, stream, 1]);
  view.setUint16(6, 91, true);
  view.setUint32(8, 7, true);
  view.setFloat64(20, 12.5, true);
  view.setFloat32(28, 0.25, true);
  return bytes;
}

class Socket {
  readyState = 1;
  binaryType = "";
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  readonly sent: string[] = [];
  send(data: string): void {
    this.sent.push(data);
  }
  close(): void {
    this.onclose?.({ code: 1000 });
  }
}

describe("the feed of poses", () => {
  it("reads what the server wrote, and nothing else", () => {
    expect(decodePose(message(2))).toMatchObject({
      stream: "actual",
      running: true,
      phaseId: 7,
      time: 12.5,
    });
    expect(decodePose(message(2))?.values[0]).toBe(0.25);
    expect(decodePose(message(3))).toBeNull();
    expect(decodeFingers(message(2))).toBeNull();
    expect(decodeFingers(message(4))).toMatchObject({ stream: "actual", phaseId: 7 });
    expect(decodeFingers(message(5))).toBeNull();
    expect(decodePose(message(1).slice(0, 60))).toBeNull();
  });

  it("reconnects after a broken connection, but not after a rejection or a close", () => {
    vi.useFakeTimers();
    const sockets: Socket[] = [];
    const states: string[] = [];
    const feed = openPoses({
      url: "/x",
      onState: (state) => states.push(state),
      onSetup: () => {},
      onPose: () => {},
      onTouches: () => {},
      open: () => {
        const socket = new Socket();
        sockets.push(socket);
        return socket as unknown as WebSocket;
      },
    });
    sockets[0]?.onmessage?.({ data: JSON.stringify(setup) });
    feed.drawn(2);
    expect(sockets[0]?.sent).toEqual(["", ""]);
    sockets[0]?.onclose?.({ code: 1006 });
    vi.advanceTimersByTime(500);
    expect(sockets.length).toBe(2);
    sockets[1]?.onclose?.({ code: 4401 });
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(2);
    expect(states).toEqual(["connecting", "live", "lost", "lost"]);
    feed.close();
    vi.useRealTimers();
  });
});
