/**
 * Move the avatar's hips with the participant's: in straight lines, or immediately after a jump. The
 * server's `app/science/avatar/simulation/hips_path.py`.
 */
import type { ModelTable } from "./modelTable";
import type { Views } from "./views";

const TELEPORT_M = 0.3;
const TELEPORT_RAD = Math.PI / 3;
const UNIT_WITHIN = 1e-3;

/** Poses are x, y, z, then w, x, y, z: seven values. */
export class HipsPath {
  teleports = 0;
  private readonly previous = Float64Array.of(0, 0, 0, 1, 0, 0, 0);
  private readonly next = new Float64Array(7);
  private readonly given = new Float64Array(7);
  private readonly posAt: number;
  private readonly quatAt: number;
  private isMoving = false;

  constructor(
    private readonly views: Views,
    private readonly table: ModelTable,
  ) {
    this.posAt = 3 * table.mocap;
    this.quatAt = 4 * table.mocap;
    for (let i = 0; i < 3; i++) this.given[i] = views.mocapPos[this.posAt + i] as number;
    for (let i = 0; i < 4; i++) this.given[3 + i] = views.mocapQuat[this.quatAt + i] as number;
    if (this.normalise()) this.previous.set(this.given);
    this.next.set(this.previous);
  }

  /**
   * Set the pose to reach by the next frame; false if it is not valid. Hips that would move too far
   * are placed there immediately.
   */
  goTo(pose: Float64Array): boolean {
    this.given.set(pose);
    if (!this.normalise()) return false;
    const { given, previous } = this;
    let squared = 0;
    let dot = 0;
    for (let i = 0; i < 3; i++) squared += ((given[i] as number) - (previous[i] as number)) ** 2;
    for (let i = 3; i < 7; i++) dot += (given[i] as number) * (previous[i] as number);
    const turnedRad = 2 * Math.acos(Math.min(Math.abs(dot), 1));
    if (Math.sqrt(squared) > TELEPORT_M || turnedRad > TELEPORT_RAD) this.jump();
    else {
      this.next.set(given);
      this.isMoving = !given.every((value, i) => value === previous[i]);
    }
    return true;
  }

  /** Put the hips into a pose immediately and at rest; false if it is not valid. */
  teleport(pose: Float64Array): boolean {
    this.given.set(pose);
    if (!this.normalise()) return false;
    this.jump();
    return true;
  }

  /** Interpolate: fraction 0 gives the last frame's pose, 1 gives this frame's. */
  go(fraction: number): void {
    if (!this.isMoving) return;
    const { previous: from, next: to } = this;
    if (fraction >= 1) {
      from.set(to);
      this.isMoving = false;
      this.write(from);
      return;
    }
    const { mocapPos, mocapQuat } = this.views;
    for (let i = 0; i < 3; i++) {
      mocapPos[this.posAt + i] =
        (from[i] as number) + fraction * ((to[i] as number) - (from[i] as number));
    }
    let dot = 0;
    for (let i = 3; i < 7; i++) dot += (from[i] as number) * (to[i] as number);
    const weightTo = dot >= 0 ? fraction : -fraction;
    let squared = 0;
    for (let i = 0; i < 4; i++) {
      const value = (1 - fraction) * (from[3 + i] as number) + weightTo * (to[3 + i] as number);
      mocapQuat[this.quatAt + i] = value;
      squared += value * value;
    }
    const scale = 1 / Math.sqrt(squared);
    for (let i = 0; i < 4; i++) {
      mocapQuat[this.quatAt + i] = (mocapQuat[this.quatAt + i] as number) * scale;
    }
  }

  /** Move welded hips to the pose of the body that they are welded to, at rest. */
  putRoot(): void {
    const { rootAngles, rootSpeeds } = this.table;
    if (rootAngles === null || rootSpeeds === null) return;
    this.views.qpos.set(this.previous, rootAngles);
    this.views.qvel.fill(0, rootSpeeds, rootSpeeds + 6);
  }

  private jump(): void {
    this.teleports += 1;
    this.previous.set(this.given);
    this.next.set(this.given);
    this.isMoving = false;
    this.write(this.given);
    this.putRoot();
  }

  private write(pose: Float64Array): void {
    const { mocapPos, mocapQuat } = this.views;
    for (let i = 0; i < 3; i++) mocapPos[this.posAt + i] = pose[i] as number;
    for (let i = 0; i < 4; i++) mocapQuat[this.quatAt + i] = pose[3 + i] as number;
  }

  /** Bring the given rotation to unit length; false if the pose is not finite or not nearly unit. */
  private normalise(): boolean {
    const { given } = this;
    let squared = 0;
    for (let i = 3; i < 7; i++) squared += (given[i] as number) ** 2;
    const length = Math.sqrt(squared);
    const isKnown = Number.isFinite(
      (given[0] as number) + (given[1] as number) + (given[2] as number),
    );
    // Comparisons with NaN are false.
    if (!(isKnown && Math.abs(length - 1) <= UNIT_WITHIN)) return false;
    for (let i = 3; i < 7; i++) given[i] = (given[i] as number) / length;
    return true;
  }
}
