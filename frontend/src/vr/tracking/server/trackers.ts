/**
 * The lab's trackers as the server brings them: OptiTrack, SlimeVR, Vive trackers and others, which
 * never reach a browser by themselves (docs/live.md).
 *
 * They come in the *anchor*: the world in which this page read the device first. The world of the
 * tracked frames moves with the start square, and this follows it; a recentre of the device that
 * says where its origin went leaves both where they are. One that does not is seen by the server as a
 * jump of the head, which then aligns anew.
 */

import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import { type FrameBuffer, set } from "../frameBuffer";
import { AT_ORIGIN, composed, inverted } from "../places";
import type { GoalPart } from "../tracked";
import type { HeadPose, TrackersMessage } from "./wire";

/** An older pose is no pose: the part counts as lost. */
export const STALE_S = 0.25;
/** The server looks at the head once a second; it need not have every frame at once. */
const SEND_EVERY_S = 0.1;
/** What a server takes in one message. */
const MOST_POSES = 256;
const HANDS: ReadonlySet<GoalPart> = new Set(["LeftHand", "RightHand"]);

export type SendHead = (poses: readonly HeadPose[]) => void;

export class ServerTrackers {
  private anchorFromWorld: Place = AT_ORIGIN;
  private worldFromAnchor: Place = AT_ORIGIN;
  private readonly places = new Map<GoalPart, Place>();
  private receivedS = Number.NEGATIVE_INFINITY;
  private isAligned = false;
  private send: SendHead | null = null;
  private head: HeadPose[] = [];
  private sentS = Number.NEGATIVE_INFINITY;
  private lastS = Number.NEGATIVE_INFINITY;

  /** Whether trackers were chosen that are not aligned: the wearer has to look around. */
  get wantsLookingAround(): boolean {
    return this.send !== null && !this.isAligned;
  }

  /** Say from now on where the head is; null: the server does not want to know. */
  sendHeadTo(send: SendHead | null): void {
    this.send = send;
    this.head = [];
    if (send === null) this.isAligned = false;
  }

  /** Take a message; `nowS` is the page's monotonic time. */
  receive(message: TrackersMessage, nowS: number): void {
    if (message.type === "trackers_state") {
      this.isAligned = message.aligned;
      if (!message.aligned) this.places.clear();
      return;
    }
    this.receivedS = nowS;
    this.places.clear();
    for (const part of GOAL_PARTS) {
      const given = message.places[part];
      if (given === undefined) continue;
      const [x, y, z, qw, qx, qy, qz] = given;
      this.places.set(part, { positionM: [x, y, z], rotation: [qw, qx, qy, qz] });
    }
  }

  /** The square was moved: `before` and `after` are its places in the device's floor space. */
  squareMoved(before: Place, after: Place): void {
    this.anchorFromWorld = composed(this.anchorFromWorld, composed(inverted(before), after));
    this.worldFromAnchor = inverted(this.anchorFromWorld);
  }

  /**
   * Put the trackers into a frame that has its eyes, and keep the eyes for the server. Held
   * controllers and tracked hands know the hands better. Returns whether both shins are tracked.
   */
  read({ timeS, eyes, parts }: FrameBuffer): boolean {
    if (eyes !== null) this.keep(timeS, eyes, parts.Head.state === "tracked");
    if (timeS - this.receivedS > STALE_S) return false;
    for (const [part, place] of this.places) {
      if (part === "Head" || (HANDS.has(part) && parts[part].place !== null)) continue;
      set(parts[part], composed(this.worldFromAnchor, place), "tracker");
    }
    return this.places.has("LeftLowerLeg") && this.places.has("RightLowerLeg");
  }

  private keep(timeS: number, eyes: Place, isTracked: boolean): void {
    if (this.send === null || timeS <= this.lastS) return;
    this.lastS = timeS;
    const { positionM, rotation } = composed(this.anchorFromWorld, eyes);
    this.head.push({ t_s: timeS, place: [...positionM, ...rotation], tracked: isTracked });
    if (this.head.length > MOST_POSES) this.head.shift();
    if (timeS - this.sentS < SEND_EVERY_S) return;
    this.sentS = timeS;
    this.send(this.head);
    this.head = [];
  }
}
