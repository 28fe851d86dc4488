/** A participant moved by mouse and keyboard, on a screen instead of in a headset. */
import type { Place } from "@shared/avatar/hips";
import { multiply } from "@shared/rotations";
import { clear, type FrameBuffer, frameBuffer, HAND_SIDES, inferHips, set } from "../frameBuffer";
import { turned } from "../places";
import { NO_OFFSETS, ScriptedPerson, type Traits, WornDevices } from "../script";
import type { GoalPart, KnownBody, TrackedFrame, TrackingSource } from "../tracked";
import { DesktopControls } from "./controls";

const MEASURES = ["Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg"] as const;
/** The body does what it is told, at once and exactly, and never tries again by itself. */
const OBEDIENT: Traits = {
  reactionS: 0,
  tempo: 0.7,
  precision: 0,
  footTempo: 1,
  patienceS: Number.POSITIVE_INFINITY,
};

export class DesktopSource implements TrackingSource {
  readonly kind = "desktop";
  readonly measures: ReadonlySet<GoalPart> = new Set(MEASURES);
  readonly knownBody: KnownBody;
  readonly controls = new DesktopControls();
  private readonly person: ScriptedPerson;
  private readonly joints: WornDevices;
  private readonly head: WornDevices;
  private readonly frame: FrameBuffer = frameBuffer();

  constructor(statureM: number) {
    this.person = new ScriptedPerson({ statureM, seed: 1, restlessness: 0, traits: OBEDIENT });
    this.knownBody = { statureM, spanM: this.person.skeleton.spanM };
    this.joints = new WornDevices(this.person, { offsets: NO_OFFSETS });
    this.head = new WornDevices(this.person);
  }

  read(timeS: number): TrackedFrame {
    const { person, controls, frame } = this;
    controls.direct(person, this.head.place("Head").positionM);
    person.advance(timeS);
    clear(frame, timeS);
    for (const part of MEASURES) set(frame.parts[part], this.joints.place(part), "joint");
    frame.eyes = this.eyes();
    inferHips(frame);
    for (const side of HAND_SIDES) {
      const hand = frame.hands[side];
      // What is looked at is pointed at: a ray out of a hanging hand would be of no use.
      const { positionM } = frame.eyes;
      hand.ray = side === controls.side ? { originM: positionM, direction: controls.gaze } : null;
      hand.isSelecting = person.selects[side];
      hand.isSqueezing = person.squeezes[side];
      hand.holdsController = true;
    }
    return frame;
  }

  dispose(): void {}

  /** The view turns with the mouse at once; the head of the body follows as heads do. */
  private eyes(): Place {
    const { yawRad, pitchRad } = this.controls;
    return {
      positionM: this.head.place("Head").positionM,
      rotation: multiply(turned([0, 1, 0], yawRad), turned([1, 0, 0], pitchRad)),
    };
  }
}
