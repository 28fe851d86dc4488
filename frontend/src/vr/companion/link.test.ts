import { afterEach, describe, expect, it, vi } from "vitest";
import { VALUES_PER_FRAME } from "../telemetry";
import { type CompanionBody, CompanionLink } from "./link";
import { companionPose, companionState } from "./wire";

class Socket {
  static all: Socket[] = [];
  readyState = 1;
  binaryType = "";
  readonly sent: unknown[] = [];
  onopen: () => void = () => undefined;
  onmessage: (event: { data: unknown }) => void = () => undefined;
  onclose: (event: { code: number }) => void = () => undefined;
  constructor() {
    Socket.all.push(this);
  }
  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }
  close(): void {}
}

const STATE = { type: "companion_state", chosen: true, stature_m: 1.8, model: null };
const state = (changes: object) => JSON.stringify({ ...STATE, in_tasks: false, ...changes });

function pose(x: number): ArrayBuffer {
  const bytes = new ArrayBuffer(4 + 4 * VALUES_PER_FRAME);
  new Uint8Array(bytes).set([82, 76, 67, 49]);
  new DataView(bytes).setFloat32(4, x, true);
  return bytes;
}

function opened() {
  Socket.all = [];
  const bodies: (CompanionBody | null)[] = [];
  const link = new CompanionLink({
    ...{ url: "ws://lab/api/vr/companion", token: "token" },
    onBody: (body) => bodies.push(body),
    makeSocket: () => new Socket() as unknown as WebSocket,
  });
  return { link, bodies, socket: Socket.all[0] as Socket };
}

afterEach(() => vi.useRealTimers());

describe("The companion's socket", () => {
  it("says while the companion is seen, and gives their newest pose", () => {
    const { link, bodies, socket } = opened();
    expect(link.look(true)).toBeNull();
    expect(socket.sent).toEqual([]);
    socket.onmessage({ data: state({}) });
    expect(bodies).toEqual([{ statureM: 1.8, model: null }]);
    expect(link.look(true)).toBeNull();
    socket.onmessage({ data: pose(1) });
    socket.onmessage({ data: pose(2) });
    expect(link.look(true)?.[0]).toBe(2);
    expect(link.look(false)).toBeNull();
    expect(socket.sent).toEqual([
      { type: "companion_seen", seen: true },
      { type: "companion_seen", seen: false },
    ]);
    socket.onmessage({ data: state({ chosen: false }) });
    expect([bodies.at(-1), link.look(true)]).toEqual([null, null]);
  });

  it("keeps the pose when only the place or the rule changes, not with another body", () => {
    const { link, bodies, socket } = opened();
    socket.onmessage({ data: state({}) });
    socket.onmessage({ data: pose(1) });
    socket.onmessage({ data: state({ in_tasks: true }) });
    expect([link.isInTasks, link.look(true)?.[0], bodies.length]).toEqual([true, 1, 1]);
    socket.onmessage({ data: state({ stature_m: 1.5 }) });
    expect([link.look(true), bodies.length]).toEqual([null, 2]);
  });

  it("opens again when it breaks and says again what is seen, unless it was refused", () => {
    vi.useFakeTimers();
    const { link, socket } = opened();
    socket.onmessage({ data: state({}) });
    socket.onmessage({ data: pose(1) });
    link.look(true);
    socket.onclose({ code: 1006 });
    expect(link.look(true)?.[0]).toBe(1);
    vi.advanceTimersByTime(1000);
    const second = Socket.all[1] as Socket;
    second.onopen();
    expect(second.sent).toEqual([{ type: "companion_seen", seen: true }]);
    second.onclose({ code: 4400 });
    vi.advanceTimersByTime(60_000);
    expect(Socket.all).toHaveLength(2);
    link.close();
  });

  it("ignores what it does not know", () => {
    expect(companionState('{"type":"later"}')).toBeNull();
    expect(companionPose(new ArrayBuffer(8), 1)).toBeNull();
    expect(companionPose(pose(1), 3)).toBeNull();
  });
});
