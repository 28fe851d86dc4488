/** Requests for downloads, disk space, scripted participants, the demo lab and the lab's state. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { DataKind } from "./types";

type Schemas = components["schemas"];
export type Export = Schemas["ExportView"];
export type StorageRoom = Schemas["StorageView"];
export type StoragePart = Schemas["PartView"];
export type StudyRoom = Schemas["StudyRoom"];
export type Tryout = Schemas["TryoutView"];
export type Demo = Schemas["DemoView"];
export type LabState = Schemas["LabState"];
export type SessionBrief = Schemas["SessionBrief"];
export type Attention = Schemas["Attention"];

const one = (id: string) => ({ params: { path: { export_id: id } } });

/** What to export: all sessions of one kind, or one session of that kind. */
export interface ExportWish {
  readonly studyKey: string;
  readonly kind: DataKind | "all";
  readonly sessionId?: string;
  /** Whether every frame of movement is included, which is nearly all of the size. */
  readonly movement?: boolean;
}

export const exports = {
  list: () => answer<readonly Export[]>(server.GET("/api/exports")),
  order: ({ studyKey, kind, sessionId, movement = true }: ExportWish) =>
    answer<Export>(
      server.POST("/api/studies/{key}/exports", {
        params: { path: { key: studyKey } },
        body: { kind, session_id: sessionId ?? null, movement },
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

/** The study of the demo lab (`DEMO_KEY` in `demo_study.py`). */
export const DEMO_KEY = "demo-lab";

export const demo = {
  get: () => answer<Demo>(server.GET("/api/demo")),
  load: (language: string) => answer<Demo>(server.POST("/api/demo", { body: { language } })),
  remove: () => answer<{ readonly rows: number }>(server.DELETE("/api/demo")),
};

/** `since`: where the reader's day begins, ISO 8601. */
export const lab = {
  get: (since: string) =>
    answer<LabState>(server.GET("/api/lab", { params: { query: { since } } })),
};
