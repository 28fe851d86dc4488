/** The body of a test: the model of a session, moved by the wearer or, without one, by a script. */
import { answer, server } from "@shared/api/request";
import { type BodiesFrame, type BodiesInWorker, openBodiesInWorker } from "../bodies";
import { Calibrator } from "../calibration";
import type { SessionAvatar } from "../session";
import { SteadyGoals, type TrackedFrame, type TrackingSource } from "../tracking";
import { GuidedPerson } from "./guided";
import type { Movement } from "./plan";

/** A body of which the server says nothing is this tall, m. */
export const USUAL_STATURE_M = 1.75;
/** Whoever shows no hand for so long is not there: a script moves the body instead, s. */
const NOBODY_AFTER_S = 2;

export class TestedBody {
  readonly #calibrator = new Calibrator();
  readonly #steady = new SteadyGoals();
  #guided = new GuidedPerson(USUAL_STATURE_M);
  #avatar: SessionAvatar | null = null;
  #bodies: BodiesInWorker | null = null;
  #handsSeenS = Number.NEGATIVE_INFINITY;
  #isGuided = false;
  #isDisposed = false;

  /** Fetch the body and start its worker. Throws ApiError, Unreachable or what the worker says. */
  async prepare(token: string, withFingers: boolean): Promise<SessionAvatar> {
    const headers = { authorization: `Bearer ${token}` };
    const avatar = await answer<SessionAvatar>(
      server.GET("/api/vr/self-tests/avatar", { headers }),
    );
    const bodies = await openBodiesInWorker({ avatar: "physics", bodies: [avatar], withFingers });
    if (this.#isDisposed) bodies.dispose();
    else {
      this.#avatar = avatar;
      this.#bodies = bodies;
      this.#guided = new GuidedPerson(avatar.stature_m);
      this.#calibrator.scaleTo(avatar.stature_m);
    }
    return avatar;
  }

  get isPrepared(): boolean {
    return this.#bodies !== null;
  }

  /** The model that is computed; null before it is there. */
  get model(): SessionAvatar | null {
    return this.#avatar;
  }

  /** Whether a script moves it now. */
  get isGuided(): boolean {
    return this.#isGuided;
  }

  get latest(): BodiesFrame | null {
    return this.#bodies?.latest() ?? null;
  }

  /** Whether every frame so far is computed. */
  get isIdle(): boolean {
    return this.#bodies?.isIdle ?? true;
  }

  async idle(): Promise<void> {
    await this.#bodies?.idle();
  }

  /** What moves the body in this frame: the wearer, or the script that follows the plan. */
  movedBy(worn: TrackedFrame, movement: Movement | null): TrackedFrame {
    const { parts, timeS } = worn;
    const hasHands = parts.LeftHand.place !== null || parts.RightHand.place !== null;
    if (hasHands && parts.Head.place !== null) this.#handsSeenS = timeS;
    const isGuided = timeS - this.#handsSeenS > NOBODY_AFTER_S;
    if (isGuided !== this.#isGuided) this.#steady.restart();
    this.#isGuided = isGuided;
    return isGuided ? this.#guided.read(timeS, movement) : worn;
  }

  kindOf(worn: TrackingSource["kind"]): TrackingSource["kind"] {
    return this.#isGuided ? "script" : worn;
  }

  /** Compute a frame; throws if the worker has failed, and then there is no body any more. */
  follow(moved: TrackedFrame): void {
    const bodies = this.#bodies;
    if (bodies === null) return;
    const goals = this.#steady.steady(moved, this.#calibrator.goals(moved));
    try {
      bodies.step({ timeS: moved.timeS, goals, fingers: null });
    } catch (error) {
      this.#bodies = null;
      throw error;
    }
  }

  dispose(): void {
    this.#isDisposed = true;
    this.#bodies?.dispose();
    this.#bodies = null;
  }
}
