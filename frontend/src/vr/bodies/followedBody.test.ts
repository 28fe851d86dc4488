import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { loadMujoco, type Mujoco } from "@shared/avatar/mujoco";
import type { ConfigurationFile, TargetSpace } from "@shared/avatar/physics/settings";
import { beforeAll, describe, expect, it } from "vitest";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import { FollowedBody } from "./followedBody";
import { answer, VECTORS } from "./testing/person";

/** `tests/vectors/avatar/README.md` describes the file. */
interface Vector {
  readonly configuration: ConfigurationFile;
  readonly frames: number;
  readonly frames_a_key: number;
  readonly every: number;
  readonly keys: {
    readonly rotations: readonly (readonly number[])[];
    readonly hips_m: readonly (readonly number[])[];
  };
  readonly cases: readonly Case[];
}
interface Case {
  readonly name: string;
  readonly target_space: TargetSpace;
  readonly fingers: boolean;
  readonly hips_scale: number;
  readonly jump?: number;
  readonly layers?: ConfigurationFile["layers"];
  readonly own_delays_s?: Readonly<Record<string, number>>;
  readonly events: readonly {
    readonly frame: number;
    readonly latency_s?: number;
    readonly surfaces?: readonly string[];
    readonly order?: AvatarOrder;
    readonly put_on?: boolean;
  }[];
  readonly held_rad: readonly Record<string, number>[];
  readonly samples: readonly {
    readonly pose: readonly number[];
    readonly touched: readonly number[];
    readonly near: readonly number[];
    readonly fingers?: readonly number[];
  }[];
}

const vector: Vector = JSON.parse(readFileSync(resolve(VECTORS, "followed.json"), "utf8"));
const ALIKE = 1e-9;
const BODY_VALUES = 4 * JOINTS.length;
const FINGER_VALUES = 4 * FINGER_PARTS.length;

let mujoco: Mujoco;
beforeAll(async () => {
  mujoco = await loadMujoco();
});

describe("the remote body is that of the scripted headset", () => {
  it.each(vector.cases)("with $name", (one) => {
    const { target_space, layers = null } = one;
    const configuration = { ...vector.configuration, target_space, layers };
    const parts = one.fingers ? [...JOINTS, ...FINGER_PARTS] : JOINTS;
    const body = new FollowedBody(
      mujoco,
      late(answer({ configuration }), one.own_delays_s ?? {}),
      one.hips_scale,
      one.fingers,
      parts,
    );
    const own = new Float64Array(3 + BODY_VALUES);
    const fingers = new Float64Array(FINGER_VALUES);
    const held: Record<string, number>[] = [];
    let greatest = 0;
    for (let frame = 0; frame < vector.frames; frame++) {
      const event = one.events.find((each) => each.frame === frame);
      if (event?.put_on) body.putOn();
      if (event?.latency_s !== undefined) body.setLatency(event.latency_s);
      if (event?.surfaces !== undefined) body.showSurfaces(event.surfaces);
      pose(frame, one.jump, own, fingers);
      body.frame(frame / 90 + 0.001 * (frame % 3), own, one.fingers ? fingers : null);
      if (event?.order) held.push({ ...body.change(event.order) });
      if (frame % vector.every !== 0) continue;
      const expected = one.samples[frame / vector.every];
      greatest = Math.max(greatest, apart(body.pose, expected?.pose ?? []));
      if (one.fingers) {
        const scalars = body.fingers?.filter((_, index) => index % 4 === 0) ?? [];
        greatest = Math.max(greatest, apart(scalars, expected?.fingers ?? []));
      }
      expect([frame, ones(body.touched)]).toEqual([frame, expected?.touched]);
      expect([frame, ones(body.near)]).toEqual([frame, expected?.near]);
    }
    expect(greatest).toBeLessThanOrEqual(ALIKE);
    expect(held.map((angles) => Object.keys(angles).sort())).toEqual(
      one.held_rad.map((angles) => Object.keys(angles).sort()),
    );
    for (const [index, angles] of held.entries()) {
      for (const [axis, angle] of Object.entries(angles)) {
        expect(Math.abs(angle - (one.held_rad[index]?.[axis] ?? Number.NaN))).toBeLessThan(ALIKE);
      }
    }
    body.dispose();
  });
});

/** An answer of which some motors of the model lag behind the others. */
function late(answered: ReturnType<typeof answer>, delaysS: Readonly<Record<string, number>>) {
  const mjcf = Object.entries(delaysS).reduce(
    (text, [name, delayS]) =>
      text.replace(new RegExp(`(<pid name="${name}".* delay=")0"`), `$1${delayS}"`),
    answered.mjcf,
  );
  return { ...answered, mjcf };
}

/** The participant's pose (91) and fingers (120), blended between two key poses. */
function pose(
  frame: number,
  jump: number | undefined,
  own: Float64Array,
  fingers: Float64Array,
): void {
  const key = Math.floor(frame / vector.frames_a_key);
  const fraction = (frame % vector.frames_a_key) / vector.frames_a_key;
  const share = fraction * fraction * (3 - 2 * fraction);
  const value = (rows: readonly (readonly number[])[], row: number, at: number) =>
    rows[row]?.[at] ?? Number.NaN;
  const { rotations, hips_m } = vector.keys;
  for (let i = 0; i < 3; i++) {
    const here = value(hips_m, key, i);
    own[i] = here + share * (value(hips_m, key + 1, i) - here);
  }
  if (jump !== undefined && frame >= jump) own[0] = (own[0] as number) + 0.5;
  for (let at = 0; at < BODY_VALUES + FINGER_VALUES; at += 4) {
    const from = [0, 1, 2, 3].map((i) => value(rotations, key, at + i));
    const to = [0, 1, 2, 3].map((i) => value(rotations, key + 1, at + i));
    const dot = from.reduce((sum, one, i) => sum + one * (to[i] as number), 0);
    const weight = dot >= 0 ? share : -share;
    const blend = from.map((one, i) => (1 - share) * one + weight * (to[i] as number));
    const scale = 1 / Math.sqrt(blend.reduce((sum, one) => sum + one * one, 0));
    const into = at < BODY_VALUES ? own : fingers;
    const first = at < BODY_VALUES ? 3 + at : at - BODY_VALUES;
    blend.forEach((one, i) => {
      into[first + i] = one * scale;
    });
  }
}

/** The greatest difference; infinite where one has no value. */
function apart(found: ArrayLike<number>, expected: readonly number[]): number {
  if (found.length !== expected.length) return Number.POSITIVE_INFINITY;
  return expected.reduce((most, one, i) => Math.max(most, Math.abs(one - (found[i] as number))), 0);
}

const ones = (flags: Uint8Array): number[] =>
  [...flags.keys()].filter((index) => flags[index] === 1);
