import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { type FeedState, openFeed, type Source } from "./live";

class FakeSource implements Source {
  readyState = 0;
  onopen: ((event: Event) => void) | null = null;
  onerror: ((event: Event) => void) | null = null;
  closed = false;
  readonly listeners = new Map<string, (event: MessageEvent<string>) => void>();

  addEventListener(type: string, listener: (event: MessageEvent<string>) => void): void {
    this.listeners.set(type, listener);
  }

  close(): void {
    this.closed = true;
  }

  send(type: string, data: unknown): void {
    this.listeners.get(type)?.({ data: JSON.stringify(data) } as MessageEvent<string>);
  }

  fail(readyState: number): void {
    this.readyState = readyState;
    this.onerror?.(new Event("error"));
  }
}

const OPENED = new Event("open");

function started() {
  const sources: FakeSource[] = [];
  const states: FeedState[] = [];
  const received: unknown[] = [];
  const stop = openFeed({
    url: "/live",
    on: { session: (data) => received.push(data) },
    onState: (state) => states.push(state),
    open: () => {
      const source = new FakeSource();
      sources.push(source);
      return source;
    },
  });
  return { sources, states, received: received, stop };
}

describe("a live feed", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("passes on the messages it receives", () => {
    const { sources, received: heard } = started();
    sources[0]?.send("session", { version: 3 });
    expect(heard).toEqual([{ version: 3 }]);
  });

  it("reports when it is live and when the connection is lost", () => {
    const { sources, states } = started();
    sources[0]?.onopen?.(OPENED);
    sources[0]?.fail(0);
    sources[0]?.onopen?.(OPENED);
    expect(states).toEqual(["connecting", "live", "lost", "live"]);
  });

  it("leaves a broken connection to the browser, which reconnects automatically", () => {
    const { sources } = started();
    sources[0]?.fail(0);
    vi.advanceTimersByTime(60_000);
    expect(sources).toHaveLength(1);
  });

  it("opens a new connection after the browser gave up, waiting longer each time", () => {
    const { sources } = started();
    sources[0]?.fail(2);
    vi.advanceTimersByTime(1000);
    expect(sources).toHaveLength(2);
    sources[1]?.fail(2);
    vi.advanceTimersByTime(1000);
    expect(sources).toHaveLength(2);
    vi.advanceTimersByTime(1000);
    expect(sources).toHaveLength(3);
  });

  it("opens no more connections once it was stopped", () => {
    const { sources, stop } = started();
    sources[0]?.fail(2);
    stop();
    vi.advanceTimersByTime(60_000);
    expect(sources).toHaveLength(1);
    expect(sources[0]?.closed).toBe(true);
  });
});
