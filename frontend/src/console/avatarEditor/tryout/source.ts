/** What the try-out asks of the server: the model of a configuration, captures, other versions. */
import { answer, server } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { JOINTS } from "@shared/avatar/anatomy.generated";
import type { PointMotion } from "@shared/stage/motion";
import { keepPreviousData, queryOptions } from "@tanstack/react-query";
import type { Capture } from "./physics/commands";
import type { BodyToTry } from "./physics/triedBody";

/** The box that can be dropped. */
const BOX = { edge_m: 0.2, mass_kg: 2 } as const;

type Schemas = components["schemas"];
export type AvatarFile = Schemas["AvatarFile"];

export const savedAvatarsQuery = queryOptions({
  queryKey: ["avatars"],
  queryFn: () => answer<Schemas["AvatarSummary"][]>(server.GET("/api/avatars")),
});

/** A saved version, named `key number`; null for none. */
export const savedVersionQuery = (name: string | null) => {
  const [key = "", number = "0"] = (name ?? "").split(" ");
  const path = { key, number: Number(number) };
  return queryOptions({
    queryKey: ["avatars", key, path.number],
    queryFn: () =>
      answer<Schemas["AvatarVersionDetail"]>(
        server.GET("/api/avatars/{key}/versions/{number}", { params: { path } }),
      ),
    enabled: name !== null,
  });
};

/** The body of a configuration, with a box to drop; the previous one stays while it is built. */
export const bodyQuery = (configuration: AvatarFile | null, statureM: number) =>
  queryOptions({
    queryKey: ["avatars", "model", statureM, JSON.stringify(configuration)],
    queryFn: async (): Promise<BodyToTry | null> => {
      if (configuration === null) return null;
      const body = { configuration, stature_m: statureM, box: BOX };
      const mjcf = await answer<string>(
        server.POST("/api/avatars/model", { body, parseAs: "text" }),
      );
      return { mjcf, configuration };
    },
    // Models are large and made in a moment: none is kept that is not shown.
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
    retry: false,
  });

/** A movement on an avatar as it is played: the hips and 22 local rotations of every frame. */
export function captureOf(motion: PointMotion): Capture | null {
  const { rotations, names, frames, rateHz, positions } = motion;
  const rows = JOINTS.map((joint) => names.indexOf(joint));
  if (rotations === undefined || frames === 0 || rows.includes(-1)) return null;
  const turns = new Float64Array(4 * JOINTS.length * frames);
  const hipsM = new Float64Array(3 * frames);
  for (let frame = 0; frame < frames; frame++) {
    const hips = 3 * (frame * names.length + (rows[0] as number));
    for (let i = 0; i < 3; i++) hipsM[3 * frame + i] = positions[hips + i] as number;
    rows.forEach((row, joint) => {
      const from = 4 * (frame * names.length + row);
      const into = 4 * (frame * JOINTS.length + joint);
      // Of any length; zero where it is unknown, and the body then keeps its target.
      const length = Math.hypot(...rotations.subarray(from, from + 4));
      for (let i = 0; i < 4; i++) turns[into + i] = (rotations[from + i] as number) / length;
    });
  }
  return { rateHz, frames, hipsM, rotations: turns };
}
