/** Where the eyes of a body are, for views without a headset. */
import { Parts } from "@shared/stage/skin/pose";
import { POSE, type Skeleton, UNIT_SKELETON, WHOLE_VALUES, writePose } from "./skeleton";

/** From the head's joint to between the eyes, as shares of the stature: the shipped figure's. */
export const EYES_FROM_HEAD = [0, 0.0543, -0.05] as const;

/**
 * Compute a body's eyes from its pose: position in metres, rotation w, x, y, z. `skeleton` is its
 * binding; by default the product's own proportions.
 */
export class BodyEyes {
  readonly positionM: [number, number, number] = [0, 0, 0];
  readonly rotation: [number, number, number, number] = [1, 0, 0, 0];
  readonly #parts: Parts;
  readonly #head: number;
  readonly #statureM: number;
  readonly #values = new Float32Array(WHOLE_VALUES);

  constructor(statureM: number, skeleton: Skeleton = UNIT_SKELETON) {
    this.#statureM = statureM;
    const scale = statureM / skeleton.stature_m;
    this.#parts = new Parts({ ...skeleton, nodes: [], part_from_node: [] }, scale, POSE);
    this.#head = skeleton.parts.indexOf("Head");
  }

  /** Move to a pose; false, and nothing moves, if it is not fully known. */
  place(pose: ArrayLike<number>): boolean {
    writePose(pose, null, this.#values);
    if (!this.#parts.place(this.#values)) return false;
    const { places, rotations } = this.#parts;
    const [px = 0, py = 0, pz = 0] = places.subarray(3 * this.#head, 3 * this.#head + 3);
    const [w = 1, x = 0, y = 0, z = 0] = rotations.subarray(4 * this.#head, 4 * this.#head + 4);
    const [vx, vy, vz] = EYES_FROM_HEAD.map((share) => share * this.#statureM) as Triple;
    const cx = 2 * (y * vz - z * vy);
    const cy = 2 * (z * vx - x * vz);
    const cz = 2 * (x * vy - y * vx);
    this.positionM[0] = px + vx + w * cx + y * cz - z * cy;
    this.positionM[1] = py + vy + w * cy + z * cx - x * cz;
    this.positionM[2] = pz + vz + w * cz + x * cy - y * cx;
    this.rotation[0] = w;
    this.rotation[1] = x;
    this.rotation[2] = y;
    this.rotation[3] = z;
    return true;
  }
}

type Triple = [number, number, number];
