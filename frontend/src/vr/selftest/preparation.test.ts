import { describe, expect, it } from "vitest";
import { AWAITED, PREPARED_WITHIN_S, Preparation } from "./preparation";

describe("The preparation of a self-test", () => {
  it("is over as soon as everything is there, and says what is awaited until then", () => {
    const preparation = new Preparation(100);
    expect(preparation.progress(103.7)).toEqual({
      kind: "preparing",
      awaited: "body",
      waitedS: 3,
    });
    preparation.settled("body");
    preparation.settled("picture");
    expect([preparation.missing, preparation.isOver(110)]).toEqual([["sending"], false]);
    preparation.settled("sending");
    expect(preparation.isOver(110)).toBe(true);
  });

  it("ends on a device on which nothing comes, not even a frame", () => {
    const preparation = new Preparation(100);
    expect(preparation.isOver(100 + PREPARED_WITHIN_S - 0.1)).toBe(false);
    expect(preparation.isOver(100 + PREPARED_WITHIN_S)).toBe(true);
    expect(preparation.missing).toEqual(AWAITED);
    expect(preparation.progress(500).waitedS).toBe(PREPARED_WITHIN_S);
  });
});
