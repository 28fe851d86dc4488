/**
 * How a scripted person stands: hips between the feet, a trunk that leans, a head that looks, legs
 * that end where the feet are, and the sway and breath of somebody alive.
 */
import { minus, multiply, plus, type Quaternion, type Vector } from "@shared/rotations";
import { conjugate, turned } from "../places";
import { INDEX, type Skeleton } from "../skeleton";
import { Follower } from "./movements";
import { legRotation, twoBone } from "./posture";
import type { Random } from "./random";

const SOFT_KNEES = 0.985;
const STRAIGHTEST = 0.995;
/** Who is told to stand upright stretches the legs but for this. */
const UPRIGHT = 0.9995;
const BODY_RATE = 7;
const LEAN_RATE = 6;
const HEIGHT_RATE = 9;
const LOOK_RATE = 8;
const SWAY_M = 0.004;
const SWAY_HZ = [0.11, 0.23, 0.41] as const;
const HEAD_RAD = 0.02;
const UP: Vector = [0, 1, 0];
const RIGHTWARDS: Vector = [1, 0, 0];
const BACKWARDS: Vector = [0, 0, 1];
const KNEE_POLE: Vector = [0, 0, -1];
const IDENTITY: Quaternion = [1, 0, 0, 0];

type Ankles = readonly [Vector, Vector];

/** What the body is to do in one frame. */
export interface Stance {
  readonly timeS: number;
  readonly stepS: number;
  /** Where hips and shoulders are to be on the floor, and the shoulders relative to the hips. */
  readonly hips: readonly [x: number, z: number];
  readonly lean: readonly [x: number, z: number];
  readonly ankles: Ankles;
  readonly lookM: Vector | null;
  /** How deep to squat, 0 to 1. */
  readonly squat: number;
  readonly isUpright: boolean;
}

export class Standing {
  rootM: Vector;
  private readonly skeleton: Skeleton;
  private readonly local: Quaternion[];
  private readonly phases: readonly number[];
  private readonly restlessness: number;
  private readonly x: Follower;
  private readonly z: Follower;
  private readonly leanX = new Follower(0, LEAN_RATE);
  private readonly leanZ = new Follower(0, LEAN_RATE);
  private readonly height: Follower;
  private readonly yaw = new Follower(0, LOOK_RATE);
  private readonly pitch = new Follower(0, LOOK_RATE);
  private readonly kneel = new Follower(0, 4);

  /** `local`: the local rotations of the whole body, of which trunk, head and legs are written. */
  constructor(
    skeleton: Skeleton,
    local: Quaternion[],
    [homeX, homeZ]: readonly [x: number, z: number],
    restlessness: number,
    random: Random,
  ) {
    this.skeleton = skeleton;
    this.local = local;
    this.restlessness = restlessness;
    this.phases = Array.from({ length: 12 }, () => 2 * Math.PI * random.next());
    this.x = new Follower(homeX, BODY_RATE);
    this.z = new Follower(homeZ, BODY_RATE);
    this.height = new Follower(SOFT_KNEES * skeleton.standingHipsM, HEIGHT_RATE);
    this.rootM = [homeX, this.height.value, homeZ];
  }

  /** Place hips, trunk, head and legs. */
  stand({ timeS, stepS, hips, lean, ankles, lookM, squat, isUpright }: Stance): void {
    const { skeleton, local } = this;
    const x = this.x.follow(hips[0], stepS) + this.wave(0, timeS) * SWAY_M;
    const z = this.z.follow(hips[1], stepS) + this.wave(3, timeS) * SWAY_M;
    this.bendTrunk(this.leanX.follow(lean[0], stepS), this.leanZ.follow(lean[1], stepS));
    this.turnHead(timeS, stepS, [x, z], lookM);
    const low = this.kneel.follow(squat, stepS);
    const knees = isUpright ? 1 : SOFT_KNEES;
    const wanted = (knees - 0.3 * low) * skeleton.standingHipsM;
    const highest = this.highestHips(x, z, ankles, isUpright ? UPRIGHT : STRAIGHTEST);
    const height = Math.min(this.height.follow(Math.min(wanted, highest), stepS), highest);
    // A person who squats moves the hips back and leans forwards, or would fall.
    this.rootM = [x, height, z + 0.12 * low];
    local[0] = IDENTITY;
    this.placeLegs(ankles);
  }

  /** Bend the three joints of the spine so that the shoulders move by about (x, z). */
  private bendTrunk(x: number, z: number): void {
    const trunkM = 0.818 * this.skeleton.statureM - this.skeleton.standingHipsM;
    const forwards = -0.35 * this.kneel.value;
    const bend = multiply(
      turned(RIGHTWARDS, z / trunkM / 3 + forwards / 3),
      turned(BACKWARDS, -x / trunkM / 3),
    );
    for (const joint of [INDEX.Spine, INDEX.Chest, INDEX.UpperChest]) this.local[joint] = bend;
  }

  private turnHead(
    timeS: number,
    stepS: number,
    [x, z]: readonly [number, number],
    lookM: Vector | null,
  ): void {
    let yaw = 0;
    let pitch = 0;
    if (lookM !== null) {
      const eyes = 0.94 * this.skeleton.statureM;
      const [dx, dy, dz] = minus(lookM, [x, eyes, z]);
      yaw = Math.min(1.2, Math.max(-1.2, Math.atan2(-dx, -dz)));
      pitch = Math.min(0.7, Math.max(-0.7, Math.atan2(dy, Math.hypot(dx, dz))));
    }
    const own = HEAD_RAD * this.wave(6, timeS);
    const nod = HEAD_RAD * this.wave(9, timeS);
    const half = multiply(
      turned(UP, (this.yaw.follow(yaw, stepS) + own) / 2),
      turned(RIGHTWARDS, (this.pitch.follow(pitch, stepS) + nod + 0.35 * this.kneel.value) / 2),
    );
    this.local[INDEX.Neck] = half;
    this.local[INDEX.Head] = half;
  }

  /** A sum of slow sines with a standard deviation of about 1, times the restlessness. */
  private wave(first: number, timeS: number): number {
    let sum = 0;
    for (const [index, hz] of SWAY_HZ.entries()) {
      sum += Math.sin(2 * Math.PI * hz * timeS + (this.phases[first + index] as number));
    }
    return this.restlessness * sum * Math.sqrt(2 / SWAY_HZ.length);
  }

  private highestHips(x: number, z: number, ankles: Ankles, straightest: number): number {
    const legM = straightest * (this.skeleton.thighM + this.skeleton.shankM);
    return Math.min(
      ...[INDEX.LeftUpperLeg, INDEX.RightUpperLeg].map((joint, side) => {
        const [sx, sy, sz] = this.skeleton.offsetsM[joint] as Vector;
        const [ax, ay, az] = ankles[side] as Vector;
        const away = (ax - x - sx) ** 2 + (az - z - sz) ** 2;
        return ay - sy + Math.sqrt(Math.max(legM * legM - away, 0));
      }),
    );
  }

  /** Knees forward, feet flat and straight ahead. */
  private placeLegs(ankles: Ankles): void {
    const { skeleton, local } = this;
    for (const [side, first] of [INDEX.LeftUpperLeg, INDEX.RightUpperLeg].entries()) {
      const socket = plus(this.rootM, skeleton.offsetsM[first] as Vector);
      const limb = twoBone(
        socket,
        ankles[side] as Vector,
        skeleton.thighM,
        skeleton.shankM,
        KNEE_POLE,
      );
      const upper = legRotation(limb.upper, limb.normal);
      const lower = legRotation(limb.lower, limb.normal);
      local[first] = upper;
      local[first + 1] = multiply(conjugate(upper), lower);
      local[first + 2] = conjugate(lower);
      local[first + 3] = IDENTITY;
    }
  }
}
