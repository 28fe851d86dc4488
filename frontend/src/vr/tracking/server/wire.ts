/** The messages of the socket over which trackers come (docs/protocol.md, section 11). */
import * as v from "valibot";

const Place = v.tuple([
  v.number(),
  v.number(),
  v.number(),
  v.number(),
  v.number(),
  v.number(),
  v.number(),
]);

const Message = v.variant("type", [
  v.object({
    type: v.literal("trackers_state"),
    /** Trackers were chosen for the session, so the head's poses are wanted. */
    wanted: v.boolean(),
    /** They are known in the headset's world. */
    aligned: v.boolean(),
  }),
  v.object({
    type: v.literal("trackers"),
    t_s: v.number(),
    /** Position x, y, z and rotation w, x, y, z of the tracker on the limb of each goal. */
    places: v.partial(
      v.object({
        Hips: Place,
        Head: Place,
        LeftHand: Place,
        RightHand: Place,
        LeftLowerLeg: Place,
        RightLowerLeg: Place,
      }),
    ),
  }),
]);
export type TrackersMessage = v.InferOutput<typeof Message>;

/** The eyes at the page's monotonic time: position x, y, z and rotation w, x, y, z. */
export interface HeadPose {
  readonly t_s: number;
  readonly place: readonly number[];
  readonly tracked: boolean;
}

/** The message in a text; null for one that this version does not know. */
export function trackersMessage(text: string): TrackersMessage | null {
  try {
    return v.parse(Message, JSON.parse(text));
  } catch {
    return null;
  }
}
