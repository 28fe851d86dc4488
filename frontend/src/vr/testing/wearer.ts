/**
 * A scripted person who wears the emulated headset: what the person does becomes poses of devices,
 * frame by frame, and the page sees a headset that somebody wears.
 *
 * The person lives in the world of the study (origin at the start square); the headset has a room
 * of its own, in which the square lies somewhere. Calibration has to find where.
 */
import type { Place } from "@shared/avatar/hips";
import type { Vector } from "@shared/rotations";
import { AT_ORIGIN, composed } from "../tracking/places";
import { type ScriptedPerson, WornDevices, type WornOptions } from "../tracking/script";
import type { EmulatedHeadset, Side } from "./emulatedHeadset";
import type { VirtualClock } from "./virtualClock";

export interface WearerOptions extends WornOptions {
  /** Where the start square lies in the room of the headset. */
  readonly roomFromSquare?: Place;
  /** Controllers strapped to the shins, as `session.trackedSources`. */
  readonly hasShinControllers?: boolean;
}

const SIDES = ["left", "right"] as const;

export class Wearer {
  private readonly devices: WornDevices;
  private room: Place;
  private readonly held: Record<Side, { select: boolean; squeeze: boolean }> = {
    left: { select: false, squeeze: false },
    right: { select: false, squeeze: false },
  };
  private readonly aims: Record<Side, Vector | null> = { left: null, right: null };

  constructor(
    readonly headset: EmulatedHeadset,
    readonly person: ScriptedPerson,
    private readonly options: WearerOptions = {},
  ) {
    this.devices = new WornDevices(person, options);
    this.room = options.roomFromSquare ?? AT_ORIGIN;
  }

  /** Point a controller's ray at a point of the study's world; null: no longer. */
  aim(side: Side, pointM: Vector | null): void {
    this.aims[side] = pointM;
    this.person.pointAt(side, pointM);
  }

  /** The square lies elsewhere now, such as after the person moved to another room. */
  moveSquare(roomFromSquare: Place): void {
    this.room = roomFromSquare;
  }

  /** Bring the devices to where the person is at a time of the page's clock. */
  move(timeS: number): void {
    const { person, headset, devices } = this;
    person.advance(timeS);
    headset.setEyes(this.inRoom(devices.place("Head")));
    for (const side of SIDES) {
      const [hand, shin] =
        side === "left"
          ? (["LeftHand", "LeftLowerLeg"] as const)
          : (["RightHand", "RightLowerLeg"] as const);
      this.moveHand(side, this.inRoom(devices.place(hand)));
      if (this.options.hasShinControllers === true) {
        headset.setTrackedSource(side, this.inRoom(devices.place(shin)));
      }
      this.press(side);
    }
  }

  /** Move and let the page draw, frame by frame. */
  step(clock: VirtualClock, frames = 1): void {
    for (let frame = 0; frame < frames; frame++) {
      this.move((clock.nowMs + clock.frameMs) / 1000);
      clock.step();
    }
  }

  private inRoom = (place: Place): Place => composed(this.room, place);

  private moveHand(side: Side, grip: Place): void {
    this.headset.setController(side, grip);
    const target = this.aims[side];
    if (target === null) return;
    const aimedM = this.inRoom({ positionM: target, rotation: [1, 0, 0, 0] }).positionM;
    this.headset.setController(side, this.headset.aimed(side, grip, aimedM));
  }

  private press(side: Side): void {
    const held = this.held[side];
    const { selects, squeezes } = this.person;
    if (held.select !== selects[side]) this.headset.press(side, "select", selects[side]);
    if (held.squeeze !== squeezes[side]) this.headset.press(side, "squeeze", squeezes[side]);
    held.select = selects[side];
    held.squeeze = squeezes[side];
  }
}
