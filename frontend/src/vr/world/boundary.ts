/**
 * Whether the space that the headset guards holds what a study makes people do, and a line on the
 * floor where it does not. This module imports three.js.
 */
import { BufferGeometry, Float32BufferAttribute, Mesh, MeshBasicMaterial } from "three";
import type { Road } from "../telemetry";
import type { Setup } from "./setups";

/** People lean and step to the side of the boxes, metres. */
export const MARGIN_M = 0.5;

/** A rectangle on the floor, metres in the world. */
export interface FloorArea {
  readonly minX: number;
  readonly maxX: number;
  readonly minZ: number;
  readonly maxZ: number;
}

/** From the start square over the road to the same place on the other side, metres. */
export function wayAcrossM({ road, starts_behind_kerb_m }: Road): number {
  return 2 * (road.lane_width_m + starts_behind_kerb_m);
}

/** What is wrong with a boundary; null: nothing. */
export type BoundaryProblem = "missing" | "too_small" | null;

/** A point of the boundary on the floor, in the world. */
export interface FloorPoint {
  readonly x: number;
  readonly z: number;
}

/** What the setups, the start square and the way across a road (m ahead) need, with the margin. */
export function areaOf(setups: Iterable<Setup>, aheadM = 0): FloorArea {
  const xs = [0];
  const zs = [0, -aheadM];
  for (const { surfaces } of setups) {
    for (const { centerM, halfSizeM } of surfaces) {
      xs.push(centerM[0] - halfSizeM[0], centerM[0] + halfSizeM[0]);
      zs.push(centerM[2] - halfSizeM[2], centerM[2] + halfSizeM[2]);
    }
  }
  return {
    minX: Math.min(...xs) - MARGIN_M,
    maxX: Math.max(...xs) + MARGIN_M,
    minZ: Math.min(...zs) - MARGIN_M,
    maxZ: Math.max(...zs) + MARGIN_M,
  };
}

/**
 * Check a `boundsGeometry` that was transformed to the world: missing or without area, or smaller
 * than what is needed. A headset without a boundary (or one that was switched off) gives no points.
 */
export function boundaryProblem(
  bounds: readonly FloorPoint[] | null,
  area: FloorArea,
): BoundaryProblem {
  if (bounds === null || bounds.length < 3) return "missing";
  const corners: readonly FloorPoint[] = [
    { x: area.minX, z: area.minZ },
    { x: area.maxX, z: area.minZ },
    { x: area.maxX, z: area.maxZ },
    { x: area.minX, z: area.maxZ },
  ];
  const inside = corners.every((corner) => isInside(corner, bounds));
  // A corner of the boundary inside the area means a dent in it.
  const dents = bounds.some(
    ({ x, z }) => x > area.minX && x < area.maxX && z > area.minZ && z < area.maxZ,
  );
  return inside && !dents ? null : "too_small";
}

/** How far a point is inside the boundary's edge; negative outside, metres. */
export function edgeDistanceM(point: FloorPoint, bounds: readonly FloorPoint[]): number {
  let nearest = Number.POSITIVE_INFINITY;
  for (let at = 0; at < bounds.length; at++) {
    const a = bounds[at];
    const b = bounds[(at + 1) % bounds.length];
    if (a === undefined || b === undefined) continue;
    const [dx, dz] = [b.x - a.x, b.z - a.z];
    const along = ((point.x - a.x) * dx + (point.z - a.z) * dz) / (dx * dx + dz * dz || 1);
    const share = Math.min(1, Math.max(0, along));
    const away = Math.hypot(point.x - a.x - share * dx, point.z - a.z - share * dz);
    nearest = Math.min(nearest, away);
  }
  return isInside(point, bounds) ? nearest : -nearest;
}

/** Width and depth of the smallest rectangle around the boundary; zero without one, metres. */
export function sizeOf(bounds: readonly FloorPoint[] | null): readonly [number, number] {
  if (bounds === null || bounds.length === 0) return [0, 0];
  const extent = (values: readonly number[]) => Math.max(...values) - Math.min(...values);
  return [extent(bounds.map(({ x }) => x)), extent(bounds.map(({ z }) => z))];
}

/** Even-odd rule. */
function isInside({ x, z }: FloorPoint, polygon: readonly FloorPoint[]): boolean {
  let isOdd = false;
  polygon.forEach((a, at) => {
    const b = polygon[(at + 1) % polygon.length] ?? a;
    if (a.z > z === b.z > z) return;
    if (x < a.x + ((z - a.z) / (b.z - a.z)) * (b.x - a.x)) isOdd = !isOdd;
  });
  return isOdd;
}

const LINE_M = 0.03;
const COLOUR = "#c77700";

/** The edge of the area that is needed, as a line on the floor. */
export function boundaryLine({ minX, maxX, minZ, maxZ }: FloorArea): Mesh {
  const corners = [
    [minX, minZ],
    [maxX, minZ],
    [maxX, maxZ],
    [minX, maxZ],
  ] as const;
  const inwards = [
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
  ] as const;
  const positions = corners.flatMap(([x, z], at) => {
    const [dx, dz] = inwards[at] ?? [0, 0];
    return [x, 0.009, z, x + dx * LINE_M, 0.009, z + dz * LINE_M];
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.setIndex(
    corners.flatMap((_, at) => {
      const [outer, next] = [2 * at, 2 * ((at + 1) % 4)];
      return [outer, outer + 1, next + 1, outer, next + 1, next];
    }),
  );
  return new Mesh(geometry, new MeshBasicMaterial({ color: COLOUR }));
}
