import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { DEFAULT_LIMITS } from "../limits";
import { Prober } from "./clockProbe";

let sent: Record<string, unknown>[];
let nowS: number;
let prober: Prober;

beforeEach(() => {
  vi.useFakeTimers();
  sent = [];
  nowS = 10;
  prober = new Prober(
    (text) => sent.push(JSON.parse(text)),
    () => nowS,
    DEFAULT_LIMITS,
  );
});

afterEach(() => {
  prober.stop();
  vi.useRealTimers();
});

function pass(seconds: number): void {
  nowS += seconds;
  vi.advanceTimersByTime(seconds * 1000);
}

const answerTo = (client_sent_s: number) => ({
  type: "probe" as const,
  client_sent_s,
  server_received_ns: "9007199254740993",
  server_sent_ns: "9007199254741993",
});
const ofType = (type: string) => sent.filter((message) => message.type === type);

describe("probing", () => {
  it("sends a probe immediately and then every second, with the client's own time", () => {
    pass(1);
    pass(1);
    expect(ofType("probe").map((probe) => probe.client_sent_s)).toEqual([10, 11, 12]);
  });

  it("reports the reading as it arrived", () => {
    prober.take(answerTo(10), 10.004);
    expect(ofType("probed")).toEqual([
      {
        type: "probed",
        client_sent_s: 10,
        server_received_ns: 9007199254740992,
        server_sent_ns: 9007199254741992,
        client_received_s: 10.004,
      },
    ]);
  });

  it("reports null after two seconds, and ignores an answer that comes later", () => {
    pass(2);
    prober.take(answerTo(10), 12.1);
    expect(ofType("probed")).toEqual([
      {
        type: "probed",
        client_sent_s: 10,
        server_received_ns: null,
        server_sent_ns: null,
        client_received_s: null,
      },
    ]);
  });

  it("takes each answer once, and ignores answers to probes it did not send", () => {
    prober.take(answerTo(10), 10.1);
    prober.take(answerTo(10), 10.2);
    prober.take(answerTo(5), 10.3);
    expect(ofType("probed")).toHaveLength(1);
  });

  it("sends nothing after it was stopped", () => {
    prober.stop();
    const before = sent.length;
    pass(1);
    pass(2);
    expect(sent.length).toBe(before);
  });
});
