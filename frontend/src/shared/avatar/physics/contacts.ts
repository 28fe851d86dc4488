/**
 * The contacts of the last step, read from MuJoCo's memory.
 *
 * `data.contact` makes an object for every contact each time it is asked for. MuJoCo 3.14 keeps
 * them at the beginning of `data.arena`, one `mjContact` of 584 bytes after another: `dist` in its
 * first eight bytes, `geom1` and `geom2` from byte 532 on. The first contact is compared with
 * `data.contact`, so a MuJoCo with another layout fails at once instead of being read wrongly.
 */
import { SimulationError } from "./modelTable";
import type { Views } from "./views";

const DOUBLES = 73;
const GEOM_AT = 133;

export class Contacts {
  /** Number of contacts in the last step; valid after `read`. */
  count = 0;
  private distances: Float64Array = new Float64Array(0);
  private indices: Int32Array = new Int32Array(0);
  private isProven = false;

  constructor(private readonly views: Views) {}

  /** Look at the contacts of the last step. */
  read(): void {
    const { arena, data } = this.views;
    this.count = data.ncon;
    if (this.count === 0 || this.distances.buffer === arena.buffer) return;
    this.distances = new Float64Array(arena.buffer, arena.byteOffset, arena.length >> 3);
    this.indices = new Int32Array(arena.buffer, arena.byteOffset, arena.length >> 2);
    if (!this.isProven) this.prove();
  }

  distanceM(contact: number): number {
    return this.distances[DOUBLES * contact] as number;
  }

  /** One of the two geoms that touch. */
  geom(contact: number, side: 0 | 1): number {
    return this.indices[2 * DOUBLES * contact + GEOM_AT + side] as number;
  }

  private prove(): void {
    const all = this.views.data.contact;
    for (let row = 0; row < this.count; row++) {
      const contact = all.get(row);
      const isSame =
        contact !== undefined &&
        Object.is(contact.dist, this.distanceM(row)) &&
        contact.geom1 === this.geom(row, 0) &&
        contact.geom2 === this.geom(row, 1);
      contact?.delete();
      if (!isSame) throw new SimulationError("This MuJoCo keeps its contacts elsewhere.");
    }
    all.delete();
    this.isProven = true;
  }
}
