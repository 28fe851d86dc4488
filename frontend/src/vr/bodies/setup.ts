/** What a page needs to make the participant's bodies. */

import type { ConfigurationFile } from "@shared/avatar/physics/settings";
import type { SegmentsM } from "./armLengths";

/** The answer of `POST /api/vr/avatar` (docs/protocol.md, section 2), as far as it is used here. */
export interface AvatarAnswer {
  readonly stature_m: number;
  /** The body's name; null for that of the session's configuration. */
  readonly body?: string | null;
  readonly mjcf: string;
  readonly configuration: ConfigurationFile;
  readonly standing_hips_m: number;
}

/** A box that can be touched: a surface of a task's layout. Metres, in the world. */
export interface SurfaceBox {
  readonly key: string;
  readonly centerM: readonly [number, number, number];
  readonly halfSizeM: readonly [number, number, number];
}

interface CommonSetup {
  /** Whether the participant's fingers are given with every frame. */
  readonly withFingers: boolean;
}

/** A body that follows by forces. */
export interface PhysicsSetup extends CommonSetup {
  readonly avatar: "physics";
  /** The configuration's body first, then those that conditions name. */
  readonly bodies: readonly [AvatarAnswer, ...AvatarAnswer[]];
}

/** A copy of the participant's own movement, delayed in every joint but the hips. */
export interface DelayedCopySetup extends CommonSetup {
  readonly avatar: "delayed_copy";
  readonly statureM: number;
  /** Measured lengths of upper arm and forearm; usual ones for what is left out. */
  readonly segmentsM?: SegmentsM;
  readonly surfaces: readonly SurfaceBox[];
}

export type BodiesSetup = PhysicsSetup | DelayedCopySetup;
