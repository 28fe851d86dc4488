/** Uneven ground as triangles: a strip along the way that rises, wide enough to walk on. */
import type { BodySetup } from "@shared/api/performers";

const HALF_WIDTH_M = 1.5;
/** How far the top goes on behind the last corner. */
const BEYOND_M = 3;

type Ground = Pick<BodySetup, "ground_start_m" | "uphill" | "profile_m">;

/** x, y, z of the corners of two triangles for each side of the profile; null for flat ground. */
export function groundStrip({ ground_start_m, uphill, profile_m }: Ground): Float32Array | null {
  const last = profile_m.at(-1);
  if (ground_start_m === null || uphill === null || last === undefined) return null;
  const corners = [...profile_m, [last[0] + BEYOND_M, last[1]] as const];
  const [startX, startZ] = ground_start_m;
  const [x, z] = uphill;
  const at = ([distance, height]: readonly [number, number], side: number) => [
    startX + distance * x - side * HALF_WIDTH_M * z,
    height,
    startZ + distance * z + side * HALF_WIDTH_M * x,
  ];
  return Float32Array.from(
    corners.slice(1).flatMap((to, index) => {
      const from = corners[index] ?? to;
      const [a, b, c, d] = [at(from, -1), at(from, 1), at(to, 1), at(to, -1)];
      return [a, b, c, a, c, d].flat();
    }),
  );
}
