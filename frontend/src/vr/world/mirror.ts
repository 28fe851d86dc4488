/**
 * The mirror as a mirrored double: the wall in front of the participant has a hole, and behind it
 * everything stands once more, reflected in the wall's plane.
 *
 * Nothing is rendered to a texture and no pass is added, so the glass is as sharp as the room, exact
 * in stereo, and works on graphics chips that draw in tiles, where a change of the render target in
 * the middle of an eye's pass does not (three.js #24048). The lights lie symmetrically to the plane
 * (`lights.ts`), so that the double is lit as its original.
 */
import { Matrix4, type Quaternion, type Vector3 } from "three";

/** A rectangle in the wall z = `planeZM`, standing on the floor, its middle at x = 0. Metres. */
export class Mirror {
  /** From the world to its reflection, and back: z -> 2 planeZM - z. */
  readonly matrix = new Matrix4();
  readonly #wallZM: number;
  #planeZM: number;

  constructor(
    planeZM: number,
    readonly widthM = 1.8,
    readonly heightM = 2,
  ) {
    this.#wallZM = planeZM;
    this.#planeZM = planeZM;
    this.isThere = true;
  }

  get planeZM(): number {
    return this.#planeZM;
  }

  /** Whether it hangs on its wall; if not, all reflections are farther away than anybody sees. */
  set isThere(isThere: boolean) {
    this.#planeZM = isThere ? this.#wallZM : FAR_AWAY_M;
    this.matrix.makeScale(1, 1, -1).setPosition(0, 0, 2 * this.#planeZM);
  }

  reflectPoint(point: Vector3): Vector3 {
    point.z = 2 * this.planeZM - point.z;
    return point;
  }

  /**
   * The rotation of the reflection of a thing that is symmetric in one of its own axes, such as a
   * box: S R S with S = diag(1, 1, -1), again a rotation, so that no faces are turned inside out.
   */
  reflectRotation(rotation: Quaternion): Quaternion {
    return rotation.set(-rotation.x, -rotation.y, rotation.z, rotation.w);
  }
}

const FAR_AWAY_M = -10_000;
/** Everything that can be reached stays this far in front of the glass, metres. */
const REACH_M = 0.5;
const NEAREST_Z_M = -1.6;

/** A mirror behind everything that a study's boxes make people reach for. */
export function mirrorBehind(nearestZM: number): Mirror {
  return new Mirror(Math.min(NEAREST_Z_M, nearestZM - REACH_M));
}
