/** The messages of the socket of the study's road (docs/protocol.md, section 12). */
import * as v from "valibot";

const whole = v.pipe(v.number(), v.integer());

const Actor = v.object({
  name: v.string(),
  kind: v.picklist(["person", "car"]),
  x_m: v.number(),
  y_m: v.number(),
  heading_rad: v.number(),
  speed_m_s: v.number(),
  turn_rad_s: v.number(),
  length_m: v.number(),
  width_m: v.number(),
});
/** A car or a walker at the time of its message. */
export type Actor = v.InferOutput<typeof Actor>;

const Message = v.variant("type", [
  v.object({
    type: v.literal("welcome"),
    run: v.string(),
    phase_id: whole,
    begins_at_s: v.number(),
    step_s: v.number(),
    next_step: whole,
  }),
  v.object({
    type: v.literal("actors"),
    step: whole,
    active_s: v.number(),
    actors: v.array(Actor),
  }),
  v.object({ type: v.literal("ended"), problem: v.string() }),
]);
export type RoadMessage = v.InferOutput<typeof Message>;

/** x, y, heading and speed on the road's floor. */
export type FloorPlace = readonly [xM: number, yM: number, headingRad: number, speedMS: number];

/** The message in a text; null for one that this version does not know. */
export function roadMessage(text: string): RoadMessage | null {
  try {
    return v.parse(Message, JSON.parse(text));
  } catch {
    return null;
  }
}
