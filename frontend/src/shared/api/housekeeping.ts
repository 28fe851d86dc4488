/** Requests for downloads, disk space and scripted participants. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { DataKind } from "./types";

type Schemas = components["schemas"];
export type Export = Schemas["ExportView"];
export type StorageRoom = Schemas["StorageView"];
export type StoragePart = Schemas["PartView"];
export type StudyRoom = Schemas["StudyRoom"];
export type Tryout = Schemas["TryoutView"];

const one = (id: string) => ({ params: { path: { export_id: id } } });

/** What to export: all sessions of one kind, or one session of that kind. */
export interface ExportWish {
  readonly studyKey: string;
  readonly kind: DataKind | "all";
  readonly sessionId?: string;
}

export const exports = {
  list: () => answer<readonly Export[]>(server.GET("/api/exports")),
  order: ({ studyKey, kind, sessionId }: ExportWish) =>
    answer<Export>(
      server.POST("/api/studies/{key}/exports", {
        params: { path: { key: studyKey } },
        body: { kind, session_id: sessionId ?? null },
      }),
    ),
  remove: (id: string) => answer<void>(server.DELETE("/api/exports/{export_id}", one(id))),
  fileUrl: (id: string) => `/api/exports/${encodeURIComponent(id)}/file`,
};

export const storageRoom = {
  get: (refresh: boolean) =>
    answer<StorageRoom>(server.GET("/api/storage", { params: { query: { anew: refresh } } })),
};

export const tryouts = {
  newest: () => answer<Tryout | null>(server.GET("/api/tryout")),
  start: (studyKey: string, language: string) =>
    answer<Tryout>(
      server.POST("/api/studies/{key}/tryout", {
        params: { path: { key: studyKey } },
        body: { language },
      }),
    ),
  stop: () => answer<Tryout>(server.DELETE("/api/tryout")),
};
