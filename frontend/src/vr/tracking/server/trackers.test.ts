import type { Place } from "@shared/avatar/hips";
import { length, minus, type Quaternion } from "@shared/rotations";
import { afterEach, describe, expect, it, vi } from "vitest";
import { type SessionInNode, sessionInNode } from "../../testing/inNode";
import { composed, inverted, onFloor, turned } from "../places";
import type { TrackedFrame } from "../tracked";
import { WebXrTracking } from "../webxr/tracking";
import { TrackerLink } from "./link";
import { ServerTrackers, STALE_S } from "./trackers";
import { type HeadPose, type TrackersMessage, trackersMessage } from "./wire";

const at = (x: number, y: number, z: number, rotation: Quaternion = [1, 0, 0, 0]): Place => ({
  positionM: [x, y, z],
  rotation,
});
const SHIN = at(0.1, 0.4, -0.2, turned([0, 0.6, 0.8], 0.7));
const EYES = at(0, 1.6, 0.1, turned([0, 1, 0], 0.3));

const near = (place: Place | null | undefined, wanted: Place): void => {
  const seen = place as Place;
  expect(length(minus(seen.positionM, wanted.positionM))).toBeLessThan(1e-5);
  const dot = seen.rotation.reduce((sum, one, n) => sum + one * (wanted.rotation[n] as number), 0);
  expect(Math.abs(dot)).toBeGreaterThan(1 - 1e-6);
};

type Values = readonly [number, number, number, number, number, number, number];
const valuesOf = ({ positionM, rotation }: Place): Values => [...positionM, ...rotation];
const shins = (left: Place, right: Place | null): TrackersMessage =>
  ({
    type: "trackers",
    t_s: 1,
    places: {
      LeftLowerLeg: valuesOf(left),
      ...(right !== null && { RightLowerLeg: valuesOf(right) }),
    },
  }) as TrackersMessage;
const ALIGNED: TrackersMessage = { type: "trackers_state", wanted: true, aligned: true };

let open: SessionInNode | null = null;
afterEach(() => {
  open?.close();
  open = null;
});

async function worn() {
  const session = await sessionInNode();
  open = session;
  const lab = new ServerTrackers();
  const sent: HeadPose[] = [];
  lab.sendHeadTo((poses) => sent.push(...poses));
  const tracking = new WebXrTracking({}, "Quest 3", lab);
  tracking.begin(session.session, session.floor);
  session.headset.setEyes(EYES);
  const read = (): TrackedFrame => session.frame((timeS, frame) => tracking.read(timeS, frame));
  read();
  return { ...session, lab, tracking, read, sent, nowS: () => session.clock.nowMs / 1000 };
}

describe("The lab's trackers in a headset", () => {
  it("give a Quest measured shins, for as long as they come", async () => {
    const { lab, read, tracking, nowS, clock } = await worn();
    lab.receive(ALIGNED, nowS());
    lab.receive(shins(SHIN, SHIN), nowS());
    const { parts } = read();
    near(parts.LeftLowerLeg.place, SHIN);
    expect(parts.LeftLowerLeg).toMatchObject({ state: "tracked", device: "tracker" });
    expect(parts.Hips.state).toBe("inferred");
    expect([tracking.kind, tracking.measures.has("LeftLowerLeg")]).toEqual([
      "server_trackers",
      true,
    ]);
    lab.receive(shins(SHIN, null), nowS());
    expect(read().parts.RightLowerLeg.state).toBe("lost");
    expect(tracking.kind).toBe("controllers");
    const lastS = nowS();
    while (nowS() - lastS <= STALE_S) clock.step();
    expect(read().parts.LeftLowerLeg.state).toBe("lost");
  });

  it("are lost at once when the alignment does not hold any more", async () => {
    const { lab, read, nowS } = await worn();
    lab.receive(shins(SHIN, SHIN), nowS());
    lab.receive({ ...ALIGNED, aligned: false } as TrackersMessage, nowS());
    expect(read().parts.LeftLowerLeg.state).toBe("lost");
  });

  it("leave hands to the controllers in them", async () => {
    const { lab, read, nowS, headset } = await worn();
    headset.setController("left", at(-0.3, 1.1, -0.4));
    read();
    lab.receive(
      {
        type: "trackers",
        t_s: 1,
        places: { LeftHand: valuesOf(SHIN), Hips: valuesOf(SHIN) },
      } as TrackersMessage,
      nowS(),
    );
    const { parts } = read();
    expect(parts.LeftHand.device).toBe("controller");
    expect(parts.Hips).toMatchObject({ state: "tracked", device: "tracker" });
  });

  it("stay in the room when the square is moved or the device recentres", async () => {
    const { lab, read, tracking, nowS, headset, sent } = await worn();
    tracking.moveSquare(onFloor(0.5, -0.3, 1.1));
    headset.recentre(onFloor(-2, 1, -1.1));
    for (let n = 0; n < 20; n++) read();
    lab.receive(shins(SHIN, SHIN), nowS());
    const seen = read();
    // The server still hears of the same head in the same place.
    near(placeOf(sent.at(-1) as HeadPose), EYES);
    const world = composed(EYES, inverted(seen.eyes as Place));
    near(composed(world, seen.parts.LeftLowerLeg.place as Place), SHIN);
  });
});

const placeOf = ({ place }: HeadPose): Place => {
  const [x = 0, y = 0, z = 0, ...rotation] = place;
  return { positionM: [x, y, z], rotation: rotation as unknown as Quaternion };
};

class FakeSocket {
  static readonly all: FakeSocket[] = [];
  readyState = 1;
  bufferedAmount = 0;
  readonly sent: string[] = [];
  onmessage: (event: { data: string }) => void = () => undefined;
  onclose: (event: { code: number }) => void = () => undefined;
  constructor() {
    FakeSocket.all.push(this);
  }
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {
    this.readyState = 3;
  }
}

describe("The socket for trackers", () => {
  it("opens again when it breaks, and stays closed when another page has the trackers", () => {
    vi.useFakeTimers();
    FakeSocket.all.length = 0;
    const link = new TrackerLink({
      url: "ws://lab/api/vr/trackers",
      token: "token",
      trackers: new ServerTrackers(),
      clock: () => 1,
      makeSocket: () => new FakeSocket() as unknown as WebSocket,
    });
    FakeSocket.all[0]?.onclose({ code: 1006 });
    vi.advanceTimersByTime(1000);
    expect(FakeSocket.all).toHaveLength(2);
    FakeSocket.all[1]?.onclose({ code: 4400 });
    vi.advanceTimersByTime(60_000);
    expect(FakeSocket.all).toHaveLength(2);
    link.close();
    vi.useRealTimers();
  });

  it("ignores what it does not know", () => {
    expect(trackersMessage('{"type":"later"}')).toBeNull();
    expect(trackersMessage("{")).toBeNull();
    expect(trackersMessage('{"type":"trackers","t_s":1,"places":{"Tail":[1]}}')).toEqual({
      type: "trackers",
      t_s: 1,
      places: {},
    });
  });
});
