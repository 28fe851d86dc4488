/**
 * The tracking of a headset for as long as its page lives, through immersive sessions that end and
 * begin again.
 */
import type { Place } from "@shared/avatar/hips";
import { deviceKeyOf } from "../devices";
import { clear, frameBuffer } from "../frameBuffer";
import { AT_ORIGIN, composed } from "../places";
import type { ServerTrackers } from "../server/trackers";
import type { GoalPart, SourceKind, TrackedFrame, TrackingSource } from "../tracked";
import { Room, type RoomListener } from "./room";
import { XR_WAYS, XrSource, type XrWay } from "./source";

const HEAD_AND_HANDS: ReadonlySet<GoalPart> = new Set<GoalPart>(["Head", "LeftHand", "RightHand"]);

export class WebXrTracking implements TrackingSource {
  readonly knownBody = null;
  private readonly nothing = frameBuffer();
  private source: XrSource | null = null;
  private currentRoom: Room | null = null;
  private ways: readonly XrWay[] = XR_WAYS;
  private square: Place = AT_ORIGIN;

  constructor(
    private readonly listener: Partial<RoomListener> = {},
    private readonly userAgent: string = globalThis.navigator?.userAgent ?? "",
    /** The lab's trackers, if the server may bring any. */
    private readonly lab: ServerTrackers | null = null,
  ) {}

  /** Track by a session; `floor` is its floor space as the device gives it. */
  begin(session: XRSession, floor: XRReferenceSpace): void {
    this.currentRoom?.dispose();
    const room = new Room(floor, {
      onSpace: (space) => {
        this.square = room.roomFromSquare;
        this.listener.onSpace?.(space);
      },
      onReset: (isKept) => this.listener.onReset?.(isKept),
    });
    this.currentRoom = room;
    this.source = new XrSource(session, room, deviceKeyOf(this.userAgent), this.lab);
    this.source.allow(this.ways);
    // The device keeps its room from session to session; so does the square in it.
    if (this.square !== AT_ORIGIN) room.placeSquare(this.square);
  }

  /** Where the start square lies in the room; null without a session. */
  get room(): Room | null {
    return this.currentRoom;
  }

  /** Where the start square lies in the device's floor space. */
  get roomFromSquare(): Place {
    return this.square;
  }

  /** Put the start square there in the device's floor space, from the next session on. */
  restoreSquare(roomFromSquare: Place): void {
    this.square = roomFromSquare;
  }

  /** Move the start square to there, in the world as it is read now. */
  moveSquare(worldFromSquare: Place): void {
    const room = this.currentRoom;
    if (room === null) return;
    const before = room.roomFromSquare;
    room.placeSquare(composed(before, worldFromSquare));
    this.lab?.squareMoved(before, room.roomFromSquare);
  }

  get kind(): SourceKind {
    return this.source?.kind ?? "controllers";
  }

  get measures(): ReadonlySet<GoalPart> {
    return this.source?.measures ?? HEAD_AND_HANDS;
  }

  /** Use only these ways of tracking; at least one of controllers and hands is needed. */
  allow(ways: readonly XrWay[]): void {
    this.source?.allow(ways);
    this.ways = ways;
  }

  read(timeS: number, frame: XRFrame | null): TrackedFrame {
    if (this.source !== null && frame !== null) return this.source.read(timeS, frame);
    clear(this.nothing, timeS);
    return this.nothing;
  }

  dispose(): void {
    this.currentRoom?.dispose();
    this.currentRoom = null;
    this.source = null;
  }
}
