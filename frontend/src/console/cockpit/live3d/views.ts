/** The cameras of the live scene. */
import type { PoseSetup } from "@shared/api/poses";
import { type Sight, sightOf } from "@shared/stage/eyes";
import type { PerspectiveCamera } from "three";
import { type Placed, rotationOf } from "./kinematics";

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

/** Vertical fields of view, degrees. */
const FIELD_DEG = { first: 78, side: 38, third: 42 } as const;

/** Place the camera; before the first pose it looks at the start square. */
export function aim(camera: PerspectiveCamera, view: View, subjects: Subjects): void {
  const first = view === "first" ? fromEyes(subjects) : null;
  camera.fov = FIELD_DEG[first === null && view === "first" ? "third" : view];
  const { fromM, toM } = first ?? outsideView(view, subjects.followed);
  camera.position.set(...fromM);
  camera.lookAt(...toM);
  camera.updateProjectionMatrix();
}

function fromEyes({ setup, eyes }: Subjects): Sight | null {
  const head = setup?.joints.indexOf("Head") ?? -1;
  if (eyes === null || head < 0) return null;
  const [x = 0, y = 0, z = 0] = eyes.positions.subarray(3 * head, 3 * head + 3);
  return sightOf([x, y, z], rotationOf(eyes.rotations, head));
}

function outsideView(view: View, followed: Placed | null): Sight {
  const [hipX = 0, , hipZ = 0] = followed?.positions ?? [];
  const x = Number.isFinite(hipX) ? hipX : 0;
  const z = Number.isFinite(hipZ) ? hipZ : 0;
  // The boxes in front of the participant are part of the picture.
  if (view === "side") {
    return { fromM: [x + 3.2, 1.2, z - 0.35], toM: [x, 0.92, z - 0.35] };
  }
  return { fromM: [x + 1.35, 1.95, z + 2.25], toM: [x, 0.92, z - 0.45] };
}
