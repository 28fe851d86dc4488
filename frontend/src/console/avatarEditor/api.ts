/** What the editor asks of the server: avatars, their versions, and every edit. */
import { answer, server } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { queryOptions } from "@tanstack/react-query";
import type { AvatarFile } from "./axes";

type Schemas = components["schemas"];
export type AvatarView = Schemas["AvatarView"];
export type AvatarVersion = Schemas["AvatarVersionView"];
export type AvatarVersionDetail = Schemas["AvatarVersionDetail"];
export type AvatarEdited = Schemas["AvatarEdited"];
export type AvatarCheck = Schemas["AvatarCheck"];
export type JointView = Schemas["JointView"];
export type Loss = Schemas["LossView"];
export type Operation = Schemas["AvatarEdit"]["operations"][number];
export type ColliderKind = AvatarFile["colliders"];

/** How the values of a version were found, as far as people say it. */
export type Made = Exclude<AvatarVersion["origin"], "shipped">;

const at = (key: string) => ({ params: { path: { key } } });

export const avatarQuery = (key: string) =>
  queryOptions({
    queryKey: ["avatars", key],
    queryFn: () => answer<AvatarView>(server.GET("/api/avatars/{key}", at(key))),
  });

export const versionQuery = (key: string, number: number) =>
  queryOptions({
    queryKey: ["avatars", key, number],
    queryFn: () =>
      answer<AvatarVersionDetail>(
        server.GET("/api/avatars/{key}/versions/{number}", { params: { path: { key, number } } }),
      ),
  });

/** A version with who uses it now: its content never changes, its use does. */
export const usageQuery = (key: string, number: number) => ({
  ...versionQuery(key, number),
  staleTime: 0,
  refetchOnMount: "always" as const,
});

export const avatars = {
  /** Apply operations; nothing is stored. */
  edit: (configuration: AvatarFile, operations: readonly Operation[]) =>
    answer<AvatarEdited>(server.POST("/api/avatars/edit", { body: { configuration, operations } })),
  check: (text: string) =>
    answer<AvatarCheck>(server.POST("/api/avatars/check", { body: { text } })),
  add: (key: string, title: string, note: string, configuration: AvatarFile, origin: Made) =>
    answer<AvatarView>(
      server.POST("/api/avatars", {
        body: { key, title, origin, note, configuration },
      }),
    ),
  addVersion: (
    key: string,
    basedOn: number,
    note: string,
    configuration: AvatarFile,
    origin: Made,
  ) =>
    answer<AvatarView>(
      server.POST("/api/avatars/{key}/versions", {
        ...at(key),
        body: { based_on: basedOn, origin, note, configuration },
      }),
    ),
  fileUrl: (key: string, number: number) =>
    `/api/avatars/${encodeURIComponent(key)}/versions/${number}/file`,
};
