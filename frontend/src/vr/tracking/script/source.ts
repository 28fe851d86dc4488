/** A scripted participant as a way of tracking. */
import {
  clear,
  FINGER_VALUES,
  type FrameBuffer,
  frameBuffer,
  HAND_SIDES,
  inferHips,
  set,
} from "../frameBuffer";
import type { GoalPart, KnownBody, TrackedFrame, TrackingDevice, TrackingSource } from "../tracked";
import { NO_OFFSETS, WornDevices, type WornOptions } from "./devices";
import type { ScriptedPerson } from "./person";

const DEVICES: Readonly<Record<GoalPart, TrackingDevice>> = {
  Hips: "tracker",
  Head: "headset",
  LeftHand: "controller",
  RightHand: "controller",
  LeftLowerLeg: "tracker",
  RightLowerLeg: "tracker",
};

export interface ScriptSourceOptions {
  /** With its devices the person must be calibrated; null: places are those of joints. */
  readonly worn?: WornOptions | null;
  readonly hasShins?: boolean;
  readonly hasWaist?: boolean;
  /** What tracks a part, if not a controller in each hand and trackers elsewhere. */
  readonly devices?: Partial<Readonly<Record<GoalPart, TrackingDevice>>>;
  /** Rotations of a hand's finger parts (60) at a time; without it no fingers are tracked. */
  readonly fingers?: ((side: "left" | "right", timeS: number) => Float64Array) | null;
}

export class ScriptSource implements TrackingSource {
  readonly kind = "script";
  readonly measures: ReadonlySet<GoalPart>;
  readonly knownBody: KnownBody | null;
  private readonly devices: WornDevices;
  private readonly frame: FrameBuffer = frameBuffer();

  constructor(
    readonly person: ScriptedPerson,
    private readonly options: ScriptSourceOptions = {},
  ) {
    const { worn = null, hasShins = true, hasWaist = false } = options;
    const { statureM, spanM } = person.skeleton;
    this.knownBody = worn === null ? { statureM, spanM } : null;
    this.devices = new WornDevices(person, worn ?? { offsets: NO_OFFSETS });
    this.measures = new Set<GoalPart>([
      "Head",
      "LeftHand",
      "RightHand",
      ...(hasShins ? (["LeftLowerLeg", "RightLowerLeg"] as const) : []),
      ...(hasWaist ? (["Hips"] as const) : []),
    ]);
  }

  read(timeS: number): TrackedFrame {
    const { person, devices, frame } = this;
    person.advance(timeS);
    clear(frame, timeS);
    for (const part of this.measures) {
      set(
        frame.parts[part],
        devices.place(part),
        this.knownBody === null ? (this.options.devices?.[part] ?? DEVICES[part]) : "joint",
      );
    }
    frame.eyes = this.knownBody === null ? frame.parts.Head.place : eyesOf(person);
    inferHips(frame);
    for (const side of HAND_SIDES) {
      const hand = frame.hands[side];
      hand.ray = person.rayOf(side);
      hand.isSelecting = person.selects[side];
      hand.isSqueezing = person.squeezes[side];
      const fingers = this.options.fingers?.(side, timeS) ?? null;
      hand.fingers = fingers?.length === FINGER_VALUES ? fingers : null;
      hand.holdsController = fingers === null;
    }
    return frame;
  }

  dispose(): void {}
}

/** The eyes of a person without a headset: what the page looks through. */
function eyesOf(person: ScriptedPerson) {
  return new WornDevices(person).place("Head");
}
