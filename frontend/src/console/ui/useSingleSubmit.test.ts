import { describe, expect, it, vi } from "vitest";
import { singly } from "./useSingleSubmit";

const settled = () => new Promise((resolve) => setTimeout(resolve));

describe("a form that is sent singly", () => {
  it("is sent once by two clicks in a row, and not again after it was sent", async () => {
    const send = vi.fn(() => Promise.resolve());
    const submit = singly<string>({ isReused: false });
    submit(send, "first");
    submit(send, "second");
    await settled();
    submit(send, "third");
    expect(send.mock.calls).toEqual([["first"]]);
  });

  it("can be sent again after it failed", async () => {
    const send = vi.fn(() => Promise.reject(new Error("no answer")));
    const submit = singly<string>({ isReused: false });
    submit(send, "first");
    submit(send, "second");
    await settled();
    submit(send, "third");
    expect(send.mock.calls).toEqual([["first"], ["third"]]);
  });

  it("can be sent again after it was sent if it is reused", async () => {
    const send = vi.fn(() => Promise.resolve());
    const submit = singly<string>({ isReused: true });
    submit(send, "first");
    submit(send, "second");
    await settled();
    submit(send, "third");
    expect(send.mock.calls).toEqual([["first"], ["third"]]);
  });
});
