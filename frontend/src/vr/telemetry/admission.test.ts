import { describe, expect, it } from "vitest";
import { Admission } from "./admission";
import { CLOSED } from "./failure";
import type { Entry } from "./journal/entries";
import type { Journal } from "./journal/journal";

const entry = (seqEnd: number): Entry => {
  return { stream: "target", epoch: 1, seqEnd, message: "x", madeAtMs: 0 };
};

/** A journal with admission control. */
function guarded() {
  const door = { places: 0, inside: [] as number[] };
  const journal = {
    get hasRoom() {
      return door.inside.length < door.places;
    },
    add: ({ seqEnd }: Entry) => door.inside.push(seqEnd),
  };
  return { door, admission: new Admission(journal as unknown as Journal) };
}

describe("admission", () => {
  it("keeps the order: no call overtakes those that wait, even when there is room again", async () => {
    const { door, admission } = guarded();
    const first = admission.enter(entry(1));
    door.places = 9;
    const second = admission.enter(entry(2));
    expect([door.inside, admission.waiting]).toEqual([[], 2]);
    admission.admit();
    await Promise.all([first, second]);
    expect(door.inside).toEqual([1, 2]);
  });

  it("admits only as many as there is room for", () => {
    const { door, admission } = guarded();
    for (const seqEnd of [1, 2]) void admission.enter(entry(seqEnd));
    door.places = 1;
    admission.admit();
    expect([door.inside, admission.waiting]).toEqual([[1], 1]);
  });

  it("rejects all waiting calls when the client has failed", async () => {
    const { admission } = guarded();
    const waiting = admission.enter(entry(1));
    admission.refuseAll(CLOSED);
    await expect(waiting).rejects.toThrow("closed");
    expect(admission.waiting).toBe(0);
  });
});
