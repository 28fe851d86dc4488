/** The cameras of the live scene. */
import type { PoseSetup } from "@shared/api/poses";
import type { PerspectiveCamera } from "three";
import { type Placed, rotateToWorld } from "./kinematics";

/** Through the participant's eyes, from their right, or from behind them. */
export type View = "first" | "side" | "third";
export const VIEWS: readonly View[] = ["first", "side", "third"];
/** The keys of the views: 1 first person, 3 third person, and 2 for the side view between them. */
export const VIEW_KEYS: Readonly<Record<View, string>> = { first: "1", side: "2", third: "3" };

interface Subjects {
  readonly setup: PoseSetup | null;
  readonly eyes: Placed | null;
  readonly followed: Placed | null;
}

type Vector = readonly [x: number, y: number, z: number];

/** Vertical fields of view, degrees. */
const FIELD_DEG = { first: 78, side: 38, third: 42 } as const;

/** Place the camera; before the first pose it looks at the start square. */
export function aim(camera: PerspectiveCamera, view: View, subjects: Subjects): void {
  const first = view === "first" ? fromEyes(subjects) : null;
  camera.fov = FIELD_DEG[first === null && view === "first" ? "third" : view];
  const [from, to] = first ?? outsideView(view, subjects.followed);
  camera.position.set(...from);
  camera.lookAt(...to);
  camera.updateProjectionMatrix();
}

function fromEyes({ setup, eyes }: Subjects): readonly [Vector, Vector] | null {
  const head = setup?.joints.indexOf("Head") ?? -1;
  if (eyes === null || head < 0) return null;
  const [x = 0, y = 0, z = 0] = eyes.positions.subarray(3 * head, 3 * head + 3);
  const [fx, fy, fz] = rotateToWorld(eyes.rotations, head, [0, 0, -1]);
  const [ux, uy, uz] = rotateToWorld(eyes.rotations, head, [0, 1, 0]);
  if (!Number.isFinite(x + fx + ux)) return null;
  // Between the top of the neck and the eyes; tilted down a little, like a headset's picture.
  const from = [x + 0.09 * ux + 0.1 * fx, y + 0.09 * uy + 0.1 * fy, z + 0.09 * uz + 0.1 * fz];
  const [ex = 0, ey = 0, ez = 0] = from;
  return [
    [ex, ey, ez],
    [ex + fx - 0.55 * ux, ey + fy - 0.55 * uy, ez + fz - 0.55 * uz],
  ];
}

function outsideView(view: View, followed: Placed | null): readonly [Vector, Vector] {
  const [hipX = 0, , hipZ = 0] = followed?.positions ?? [];
  const x = Number.isFinite(hipX) ? hipX : 0;
  const z = Number.isFinite(hipZ) ? hipZ : 0;
  // The boxes in front of the participant are part of the picture.
  if (view === "side") {
    return [
      [x + 3.2, 1.2, z - 0.35],
      [x, 0.92, z - 0.35],
    ];
  }
  return [
    [x + 1.35, 1.95, z + 2.25],
    [x, 0.92, z - 0.45],
  ];
}
