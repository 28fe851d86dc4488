import { afterEach, describe, expect, it } from "vitest";
import { type SessionInNode, sessionInNode } from "../../testing/inNode";
import { onFloor } from "../places";
import { Boundary } from "./boundary";
import { Room } from "./room";

let worn: SessionInNode | null = null;
afterEach(() => worn?.close());

async function guarded(corners: readonly (readonly [number, number])[] | null) {
  worn = await sessionInNode();
  if (corners !== null) worn.headset.setBounds(corners);
  return { worn, boundary: await Boundary.of(worn.session) };
}

describe("the boundary of a headset", () => {
  it("is told in the world of the study, wherever its square lies in the room", async () => {
    const corners = [
      [-1, -2],
      [1, -2],
      [1, 2],
    ] as const;
    const { worn, boundary } = await guarded(corners);
    const room = new Room(worn.floor, { onSpace: () => {}, onReset: () => {} });
    // A quarter turn to the left: the square's front is the room's left.
    room.placeSquare(onFloor(0.5, 0, Math.PI / 2));
    const found = worn.frame((_, frame) => boundary?.corners(frame, room.space));
    const rounded = found?.map(({ x, z }) => [
      Math.round(x * 1e6) / 1e6,
      Math.round(z * 1e6) / 1e6,
    ]);
    expect(rounded).toEqual([
      [2, -1.5],
      [2, 0.5],
      [-2, 0.5],
    ]);
  });

  it("is missing where nothing was set up, and unknown where the browser tells nothing", async () => {
    const empty = await guarded([]);
    const { floor } = empty.worn;
    expect(empty.worn.frame((_, frame) => empty.boundary?.corners(frame, floor))).toBeNull();
    empty.worn.close();
    expect((await guarded(null)).boundary).toBeNull();
  });
});
