/** Requests for walking: scenes, sets of walks, models and their predictions. */
import { accountHeader, answer, errorFromBody, server, whyNotSent } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type SceneListed = Schemas["SceneListed"];
/** A tuple, which the server's description does not distinguish from other lists. */
export type Point = readonly [number, number];
type With<Type, Exact> = Omit<Type, keyof Exact> & Exact;
export type Scene = With<
  Schemas["SceneView"],
  {
    readonly bounds_m: readonly [number, number, number, number];
    readonly obstacles: readonly With<
      Schemas["ObstacleView"],
      { readonly corners_m: readonly Point[] }
    >[];
    readonly places: Readonly<Record<string, Point>>;
  }
>;
export type WalkCensus = With<
  Schemas["CensusView"],
  { readonly quartiles_m: readonly [number, number, number] }
>;
export type Population = Schemas["PopulationView"];
export type WalkSet = With<
  Schemas["WalkSetView"],
  { readonly summary: With<Schemas["WalksSummary"], { readonly census: WalkCensus }> }
>;
export type NewWalkSet = Schemas["NewWalkSet"];
export type NewModel = Schemas["NewModel"];
export type ModelListed = Schemas["ModelListed"];
export type ModelSummary = With<Schemas["ModelSummary"], { readonly census: WalkCensus }>;
export type Model = With<Schemas["ModelView"], { readonly summary: ModelSummary | null }>;
export type Prediction = With<
  Schemas["PredictionView"],
  {
    readonly points_m: readonly Point[];
    readonly walkers: readonly With<Schemas["SampledWalk"], { readonly xy_m: readonly Point[] }>[];
  }
>;
export type PredictionRequest = Schemas["PredictionAsked"];
export type Slice = Schemas["SliceView"];
export type SliceRequest = Schemas["SliceAsked"];
export type Range = Schemas["Range"];

export interface Table {
  readonly file: File;
  readonly title: string;
  readonly synthetic: boolean;
  readonly rateHz: number | null;
  readonly metresPerUnit: number | null;
  /** Lines such as `A=1.78`. */
  readonly statures: readonly string[];
}

const model = (id: string) => ({ params: { path: { model_id: id } } });
const scene = (key: string) => ({ params: { path: { scene_key: key } } });

export const walking = {
  scenes: () => answer<readonly SceneListed[]>(server.GET("/api/walking/scenes")),
  scene: (key: string) => answer<Scene>(server.GET("/api/walking/scenes/{scene_key}", scene(key))),
  addScene: (text: string) => answer<Scene>(server.POST("/api/walking/scenes", { body: { text } })),
  removeScene: (key: string) =>
    answer<undefined>(server.DELETE("/api/walking/scenes/{scene_key}", scene(key))),
  sceneFile: (key: string) => `/api/walking/scenes/${encodeURIComponent(key)}/file`,
  populations: () => answer<readonly Population[]>(server.GET("/api/walking/populations")),
  walkSets: () => answer<readonly WalkSet[]>(server.GET("/api/walking/walk-sets")),
  addWalkSet: (body: NewWalkSet) =>
    answer<WalkSet>(server.POST("/api/walking/walk-sets", { body })),
  addTable,
  removeWalkSet: (id: string) =>
    answer<undefined>(
      server.DELETE("/api/walking/walk-sets/{set_id}", { params: { path: { set_id: id } } }),
    ),
  models: () => answer<readonly ModelListed[]>(server.GET("/api/walking/models")),
  addModel: (body: NewModel) => answer<Model>(server.POST("/api/walking/models", { body })),
  model: (id: string) => answer<Model>(server.GET("/api/walking/models/{model_id}", model(id))),
  stopModel: (id: string) =>
    answer<Model>(server.POST("/api/walking/models/{model_id}/stop", model(id))),
  resumeModel: (id: string) =>
    answer<Model>(server.POST("/api/walking/models/{model_id}/resume", model(id))),
  removeModel: (id: string) =>
    answer<undefined>(server.DELETE("/api/walking/models/{model_id}", model(id))),
  modelFile: (id: string) => `/api/walking/models/${encodeURIComponent(id)}/file`,
  predict: (id: string, body: PredictionRequest) =>
    answer<Prediction>(
      server.POST("/api/walking/models/{model_id}/prediction", { ...model(id), body }),
    ),
  slice: (id: string, body: SliceRequest) =>
    answer<Slice>(server.POST("/api/walking/models/{model_id}/slice", { ...model(id), body })),
};

async function addTable(table: Table): Promise<WalkSet> {
  const query = new URLSearchParams({
    name: table.file.name,
    title: table.title,
    kind: table.synthetic ? "synthetic" : "human",
  });
  if (table.rateHz !== null) query.set("rate_hz", String(table.rateHz));
  if (table.metresPerUnit !== null) query.set("metres_per_unit", String(table.metresPerUnit));
  for (const stature of table.statures) query.append("stature", stature);
  const response = await fetch(`/api/walking/walk-sets/tracks?${query}`, {
    method: "POST",
    credentials: "same-origin",
    headers: { "content-type": "application/octet-stream", ...accountHeader() },
    body: table.file,
  }).catch(async (cause: unknown) => {
    throw await whyNotSent([table.file], cause);
  });
  const body: unknown = await response.json().catch(() => null);
  if (!response.ok) throw errorFromBody(response.status, body);
  return body as WalkSet;
}
