import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { DEFAULT_LIMITS } from "../limits";
import { FakeSocket } from "../testing/fakeServer";
import { Channel, type Ending } from "./channel";

const ADDRESS = { url: "ws://test", token: "TOKEN" };
let socket: FakeSocket;
let channel: Channel;
let received: string[];
let ending: Ending | null;

beforeEach(() => {
  vi.useFakeTimers();
  received = [];
  ending = null;
  const make = (_url: string, protocols: string[]) => {
    socket = new FakeSocket(protocols, () => undefined);
    return socket as unknown as WebSocket;
  };
  channel = new Channel(
    ADDRESS,
    DEFAULT_LIMITS,
    make,
    () => received.push("open"),
    (text) => received.push(text),
  );
  void channel.ended.then((how) => {
    ending = how;
  });
});

afterEach(() => {
  vi.useRealTimers();
});

describe("a channel", () => {
  it("ends as broken if it is not answered in time", async () => {
    socket.open();
    await vi.advanceTimersByTimeAsync(9_900);
    expect(ending).toBe(null);
    await vi.advanceTimersByTimeAsync(200);
    expect(ending).toEqual({ code: 1006, reason: "" });
    expect(socket.readyState).toBe(WebSocket.CLOSED);
  });

  it("stays open as long as something is received now and then", async () => {
    socket.open();
    for (let second = 0; second < 60; second += 5) {
      socket.receive("news");
      await vi.advanceTimersByTimeAsync(5_000);
    }
    expect(ending).toBe(null);
    await vi.advanceTimersByTimeAsync(2_000);
    expect(ending).toEqual({ code: 1006, reason: "" });
  });

  it("ends with the server's code and reason, and passes nothing on after that", async () => {
    socket.open();
    socket.breaks(4401, "replaced");
    await vi.advanceTimersByTimeAsync(0);
    expect(ending).toEqual({ code: 4401, reason: "replaced" });
    socket.receive("late");
    await vi.advanceTimersByTimeAsync(0);
    expect([received, channel.isOpen]).toEqual([["open"], false]);
  });

  it("does not wait for the closing handshake of a dead network", async () => {
    socket.open();
    const shut = vi.spyOn(socket, "close").mockImplementation(() => undefined);
    channel.close(1000);
    await vi.advanceTimersByTimeAsync(0);
    expect(ending).toEqual({ code: 1000, reason: "" });
    expect(shut).toHaveBeenCalledWith(1000, "");
  });

  it("waits while the network takes nothing, but only while it is open", async () => {
    socket.open();
    const [first, second] = [vi.fn(), vi.fn()];
    socket.bufferedAmount = DEFAULT_LIMITS.bufferedBytes;
    void channel.room().then(first);
    await vi.advanceTimersByTimeAsync(100);
    expect(first).not.toHaveBeenCalled();
    socket.bufferedAmount--;
    await vi.advanceTimersByTimeAsync(20);
    expect(first).toHaveBeenCalled();
    socket.bufferedAmount = DEFAULT_LIMITS.bufferedBytes;
    void channel.room().then(second);
    socket.breaks();
    await vi.advanceTimersByTimeAsync(20);
    expect(second).toHaveBeenCalled();
  });
});
