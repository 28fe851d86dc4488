import { ApiError, Unreachable } from "@shared/api/request";
import { describe, expect, it } from "vitest";
import { type Keep, Outbox, type Send, waitMs } from "./outbox";
import type { Report, SelfTestView } from "./report";

const report = (id: string): Report => ({ id }) as Report;
const view = (id: string): SelfTestView => ({ id }) as SelfTestView;

function keeping(): Keep & { readonly values: Map<string, string> } {
  const values = new Map<string, string>();
  return {
    values,
    getItem: (key) => values.get(key) ?? null,
    setItem: (key, value) => void values.set(key, value),
    removeItem: (key) => void values.delete(key),
  };
}

describe("a report", () => {
  it("stays on the device until the server has confirmed it, also through another page", async () => {
    const keep = keeping();
    const away: Send = () => Promise.reject(new Unreachable("away"));
    const first = new Outbox(keep);
    first.add(report("a"));
    first.add(report("b"));
    expect(await first.deliver(away)).toMatchObject({ stored: [], waiting: 2 });
    const second = new Outbox(keep);
    const sent: string[] = [];
    const back: Send = async ({ id }) => {
      sent.push(id);
      return view(id);
    };
    const { stored, waiting, error } = await second.deliver(back);
    expect([stored.map(({ id }) => id), waiting, error]).toEqual([["a", "b"], 0, null]);
    expect(sent).toEqual(["a", "b"]);
    expect(keep.values.size).toBe(0);
  });

  it("that the server cannot take is kept, and holds up no other", async () => {
    const outbox = new Outbox(keeping());
    for (const id of ["bad", "good"]) outbox.add(report(id));
    const refused = new ApiError(422, { code: "invalid", message: "no" });
    const send: Send = async ({ id }) => {
      if (id === "bad") throw refused;
      return view(id);
    };
    const { stored, waiting, error } = await outbox.deliver(send);
    expect([stored.length, waiting, error]).toEqual([1, 1, refused]);
    expect(outbox.reports.map(({ id }) => id)).toEqual(["bad"]);
  });

  it("that the server refuses for good is named with the reason, until it is discarded", async () => {
    const outbox = new Outbox(keeping());
    const answers = new Map(
      [422, 503, 401].map((status) => [
        `${status}`,
        new ApiError(status, { code: "x", message: "no" }),
      ]),
    );
    for (const id of answers.keys()) outbox.add(report(id));
    const { refused, waiting } = await outbox.deliver(({ id }) => Promise.reject(answers.get(id)));
    expect(waiting).toBe(3);
    expect(refused).toEqual([{ id: "422", error: answers.get("422") }]);
    outbox.discard(refused.map(({ id }) => id));
    expect(outbox.reports.map(({ id }) => id)).toEqual(["503", "401"]);
  });

  it("replaces its earlier state, is sent when it is whole, and again after growing waits", async () => {
    const keep = keeping();
    const outbox = new Outbox(keep);
    outbox.add({ ...report("a"), duration_s: 1 });
    outbox.add({ ...report("a"), duration_s: 2 });
    expect(outbox.reports).toEqual([{ id: "a", duration_s: 2 }]);
    outbox.keep({ ...report("a"), duration_s: 3 });
    expect(new Outbox(keep).reports).toHaveLength(1);
    let calls = 0;
    const send: Send = async ({ id }) => {
      calls += 1;
      return view(id);
    };
    await outbox.deliver(send);
    expect(calls).toBe(0);
    outbox.add({ ...report("a"), duration_s: 4 });
    expect(await outbox.deliver(send)).toMatchObject({ waiting: 0 });
    expect([0, 1, 2, 9].map(waitMs)).toEqual([3000, 6000, 12_000, 60_000]);
  });

  it("that is added while others are sent is not lost, and none is sent twice at a time", async () => {
    const outbox = new Outbox(keeping());
    outbox.add(report("a"));
    let calls = 0;
    const send: Send = async ({ id }) => {
      calls += 1;
      if (id === "a") outbox.add(report("b"));
      return view(id);
    };
    await Promise.all([outbox.deliver(send), outbox.deliver(send)]);
    expect(calls).toBe(1);
    expect(outbox.reports.map(({ id }) => id)).toEqual(["b"]);
  });
});
