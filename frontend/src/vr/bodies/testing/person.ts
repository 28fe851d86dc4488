/** What tests of the bodies share: the model of the vectors, and a person who moves. */
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { AXES } from "@shared/avatar/anatomy.generated";
import type { ConfigurationFile } from "@shared/avatar/physics/settings";
import type { AvatarAnswer, PhysicsSetup } from "../setup";

export const VECTORS = resolve(import.meta.dirname, "../../../../../tests/vectors/avatar");
export const bodyXml = (): string => readFileSync(resolve(VECTORS, "body.xml"), "utf8");

const DEGREES = 180 / Math.PI;

export function configuration(changed: Partial<ConfigurationFile> = {}): ConfigurationFile {
  return {
    gravity: true,
    self_collision: true,
    target_space: "local",
    colliders: "simple",
    part_colliders: {},
    locked_groups: [],
    held_deg: {},
    axes: Object.fromEntries(
      AXES.map(({ name, lowRad, highRad }) => [
        name,
        {
          kp_nm_per_rad: 100,
          kd_nm_s_per_rad: 10,
          max_torque_nm: 100,
          low_deg: lowRad * DEGREES,
          high_deg: highRad * DEGREES,
        },
      ]),
    ),
    ...changed,
  };
}

export const answer = (changed: Partial<AvatarAnswer> = {}): AvatarAnswer => ({
  stature_m: 1.75,
  mjcf: bodyXml(),
  configuration: configuration(),
  standing_hips_m: 0.95375,
  ...changed,
});

export const physicsSetup = (withFingers = false): PhysicsSetup => ({
  avatar: "physics",
  withFingers,
  bodies: [answer()],
});
