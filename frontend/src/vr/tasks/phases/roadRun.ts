/**
 * A phase on the study's road: the active clock, where the participant was at each step of the scene,
 * and the crossings done. The server's `app/rehearsal/road_run.py`.
 */
import type { FloorPlace } from "../../road";
import type { PhaseOrder, ReportBody, Road } from "../../telemetry";
import { type Awaited, FreeRun, NOTHING, type Reports } from "./timedRun";

/** Somebody who is this far behind the other kerb is across, m. */
const ACROSS_M = 0.3;
/** Whoever is this near to the middle of the start square, on its pavement, stands on it, m. */
const AT_START_M = 0.5;
const STANDING_M_S = 0.05;

export class RoadRun extends FreeRun {
  readonly #road: Road;
  /** The active time of the scene's step 0. */
  #beginsAtS: number;
  #done: number;
  #sinceS: number;
  #news: ReportBody[] = [];
  #side = 0;
  #isAtStart = false;
  #hasTraffic = true;
  #headingRad = Math.PI / 2;
  #nextStep = 0;
  #last: readonly [activeS: number, xM: number, yM: number] | null = null;

  constructor(order: PhaseOrder, road: Road, timeS: number) {
    super(order, timeS);
    this.#road = road;
    this.#beginsAtS = order.active_s;
    this.#sinceS = order.active_s;
    this.#done = order.completions;
  }

  /** Crossings done in this phase, with those of earlier runs of the client. */
  get completed(): number {
    return this.#done;
  }

  /** From the start square over the road to the same place on the other side, m. */
  get wayAcrossM(): number {
    return 2 * (this.#road.road.lane_width_m + this.#road.starts_behind_kerb_m);
  }

  override get endsEarly(): boolean {
    const required = this.order.until_completions;
    return required !== null && this.clockRuns && this.#done >= required;
  }

  /**
   * The clock starts once the participant is on the start square and cars drive; after a pause it only
   * waits for the cars.
   */
  override get awaits(): Awaited | null {
    if (this.clock.lastS === null && !this.#isAtStart) return "start";
    return this.#hasTraffic ? null : "traffic";
  }

  /** Say whether the scene goes on: the clock waits for it. */
  followTraffic(hasTraffic: boolean): void {
    this.#hasTraffic = hasTraffic;
  }

  /** A scene begins now: its steps count from here. Returns where the participant stands. */
  enterScene(timeS: number, xM: number, zM: number): FloorPlace {
    this.#beginsAtS = this.activeS(timeS);
    this.#nextStep = 0;
    this.#last = null;
    return [xM, this.#yOf(zM), this.#headingRad, 0];
  }

  /** Take where the participant is in a frame; returns the places of the steps until then. */
  walk(timeS: number, xM: number, zM: number): readonly FloorPlace[] {
    const yM = this.#yOf(zM);
    const side = this.#sideOf(yM);
    this.#isAtStart = Math.hypot(xM, zM) <= AT_START_M && yM <= -this.#road.road.lane_width_m;
    const activeS = this.activeS(timeS);
    if (this.#last === null || !this.clockRuns) {
      // While the clock stands people may walk, also across; what follows begins where they are.
      this.#last = [activeS, xM, yM];
      this.#side = side || this.#side;
      return this.clockRuns ? this.#first(xM, yM) : [];
    }
    const found = this.#places(this.#last, activeS, xM, yM);
    this.#last = [activeS, xM, yM];
    if (side !== 0 && this.#side !== 0 && side !== this.#side) this.#cross(timeS);
    this.#side = side || this.#side;
    return found;
  }

  protected override news(): Reports {
    if (this.#news.length === 0) return NOTHING;
    const news = this.#news;
    this.#news = [];
    return news;
  }

  #yOf(zM: number): number {
    return -zM - this.#road.road.lane_width_m - this.#road.starts_behind_kerb_m;
  }

  #sideOf(yM: number): number {
    return Math.abs(yM) < this.#road.road.lane_width_m + ACROSS_M ? 0 : Math.sign(yM);
  }

  #first(xM: number, yM: number): FloorPlace[] {
    if (this.#nextStep > 0) return [];
    this.#nextStep = 1;
    return [[xM, yM, this.#headingRad, 0]];
  }

  /** The places between the last frame and this one, interpolated. */
  #places(
    [beforeS, beforeXM, beforeYM]: readonly [number, number, number],
    activeS: number,
    xM: number,
    yM: number,
  ): FloorPlace[] {
    const found = this.#first(beforeXM, beforeYM);
    const tookS = activeS - beforeS;
    if (tookS <= 0) return found;
    const [dx, dy] = [xM - beforeXM, yM - beforeYM];
    const speed = Math.hypot(dx, dy) / tookS;
    if (speed > STANDING_M_S) this.#headingRad = Math.atan2(dy, dx);
    for (;;) {
      const atS = this.#beginsAtS + this.#nextStep * this.#road.step_s;
      if (atS > activeS + 1e-9) return found;
      const share = (atS - beforeS) / tookS;
      found.push([beforeXM + share * dx, beforeYM + share * dy, this.#headingRad, speed]);
      this.#nextStep++;
    }
  }

  #cross(timeS: number): void {
    const activeS = this.activeS(timeS);
    this.#done++;
    this.#news.push({
      kind: "completion",
      phase_id: this.order.phase_id,
      number: this.#done,
      t_s: timeS,
      active_s: activeS,
      duration_s: Math.max(0, activeS - this.#sinceS),
      order: [],
      out_of_order_touches: 0,
    });
    this.#sinceS = activeS;
  }
}
