/** The queries of bodies. Everything of one body is cached under its hash. */
import { bodies } from "@shared/api/bodies";
import { answer, server } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { queryOptions } from "@tanstack/react-query";

type Schemas = components["schemas"];
export type AvatarSummary = Schemas["AvatarSummary"];
export type AvatarView = Schemas["AvatarView"];

export const bodiesQuery = queryOptions({ queryKey: ["bodies"], queryFn: bodies.list });

export const bodyQuery = (hash: string) =>
  queryOptions({ queryKey: ["bodies", hash], queryFn: () => bodies.get(hash) });

export const bodyUseQuery = (hash: string) =>
  queryOptions({ queryKey: ["bodies", hash, "use"], queryFn: () => bodies.use(hash) });

export const avatarsQuery = queryOptions({
  queryKey: ["avatars"],
  queryFn: () => answer<readonly AvatarSummary[]>(server.GET("/api/avatars")),
});

const avatarAt = (key: string) =>
  answer<AvatarView>(server.GET("/api/avatars/{key}", { params: { path: { key } } }));

/**
 * Save the configuration `base` with another body: as the next version of `key`, or under that key
 * if it is new. Returns the key and the number of the version.
 */
export async function saveWearing(
  base: string,
  key: string,
  hash: string,
  known: readonly AvatarSummary[],
): Promise<{ readonly key: string; readonly version: number }> {
  const { newest } = await avatarAt(base);
  const configuration = { ...newest.configuration, humanoid: hash };
  const origin = "by_hand" as const;
  const note = `${base}, version ${newest.number}, with another body`;
  const there = known.find((one) => one.key === key);
  const saved = await (there === undefined
    ? answer<AvatarView>(
        server.POST("/api/avatars", { body: { key, title: key, origin, note, configuration } }),
      )
    : answer<AvatarView>(
        server.POST("/api/avatars/{key}/versions", {
          params: { path: { key } },
          body: { based_on: there.newest.number, origin, note, configuration },
        }),
      ));
  return { key, version: saved.newest.number };
}
