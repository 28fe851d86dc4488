/**
 * The headset's room, and where the study's world lies in it.
 *
 * WebXR's `local-floor` has its origin where the device puts it, and the wearer can move it
 * (recentre). The study's origin is the middle of the start square, and participants face -z there.
 * `Room` holds the place of the square and offers it as a reference space, in which every pose is
 * read and the scene is drawn.
 *
 * When the device recentres, it fires `reset` on its floor space, with the new origin in the old
 * space where it knows it. Then the square stays where it is in the room: nobody has to be
 * calibrated again. Without that transform the square is lost, and the participant must stand on it
 * again.
 */
import type { Place } from "@shared/avatar/hips";
import { AT_ORIGIN, composed, headingOf, inverted, onFloor, placeOf } from "../places";

export interface RoomListener {
  /** The space has changed: give it to the renderer. */
  readonly onSpace: (space: XRReferenceSpace) => void;
  /** The device has recentred; `isKept` if the square could be kept where it was. */
  readonly onReset: (isKept: boolean) => void;
}

export class Room {
  private square: Place = AT_ORIGIN;
  private shown: XRReferenceSpace;
  private readonly reset = (event: XRReferenceSpaceEvent): void => this.follow(event);

  constructor(
    /** The session's floor space, as the device gives it. */
    private readonly floor: XRReferenceSpace,
    private readonly listener: RoomListener,
  ) {
    this.shown = floor;
    floor.addEventListener("reset", this.reset);
  }

  /** The reference space of the study's world. */
  get space(): XRReferenceSpace {
    return this.shown;
  }

  /** Where the start square lies in the device's floor space. */
  get roomFromSquare(): Place {
    return this.square;
  }

  /** Put the square somewhere else in the device's floor space; it stays level. */
  placeSquare(roomFromSquare: Place): void {
    const [x, , z] = roomFromSquare.positionM;
    this.square = onFloor(x, z, headingOf(roomFromSquare));
    const { positionM, rotation } = this.square;
    const [w, qx, qy, qz] = rotation;
    this.shown = this.floor.getOffsetReferenceSpace(
      new XRRigidTransform(
        { x: positionM[0], y: positionM[1], z: positionM[2] },
        { x: qx, y: qy, z: qz, w },
      ),
    );
    this.listener.onSpace(this.shown);
  }

  /**
   * The participant stands on the square and faces its front: put it below the eyes, turned as they
   * look. `parts` keeps the position or the heading as it is. `eyes` are in the study's world.
   */
  recentreAt(eyes: Place, parts: { position?: boolean; heading?: boolean } = {}): void {
    const { position = true, heading = true } = parts;
    const [x, , z] = position ? eyes.positionM : [0, 0, 0];
    const moved = onFloor(x, z, heading ? headingOf(eyes) : 0);
    this.placeSquare(composed(this.square, moved));
  }

  dispose(): void {
    this.floor.removeEventListener("reset", this.reset);
  }

  private follow({ transform }: XRReferenceSpaceEvent): void {
    const isKept = transform !== undefined && transform !== null;
    // The event gives the new origin in the old space.
    if (isKept) this.placeSquare(composed(inverted(placeOf(transform)), this.square));
    this.listener.onReset(isKept);
  }
}
