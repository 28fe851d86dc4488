/** Requests for bodies: humanoid models by the hash of their content. */
import type { BodyBinding } from "../stage/skin/pose";
import { accountHeader, answer, errorFromBody, server, Unreachable } from "./request";
import type { components } from "./schema";
import { upload } from "./upload";

type Schemas = components["schemas"];
export type BodyListed = Schemas["HumanoidListed"];
export type BodyView = Schemas["HumanoidView"];
export type BodyPage = Schemas["HumanoidPage"];
export type BodyUse = Schemas["BodyUse"];
export type BodyCheck = Schemas["BodyCheck"];
export type BodyChange = Schemas["BodyChange"];
export type LicenceTerm = BodyView["asked"][number];

const fetched = async (path: string): Promise<Response> => {
  const response = await fetch(path, {
    credentials: "same-origin",
    headers: accountHeader(),
  }).catch((cause: unknown) => {
    throw new Unreachable("The server cannot be reached.", { cause });
  });
  if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
  return response;
};

const at = (hash: string) => ({ params: { path: { content_hash: hash } } });
const address = (hash: string) => `/api/humanoids/${encodeURIComponent(hash)}`;

export const bodies = {
  list: () =>
    answer<BodyPage>(server.GET("/api/humanoids", { params: { query: { limit: 1000 } } })),
  get: (hash: string) => answer<BodyView>(server.GET("/api/humanoids/{content_hash}", at(hash))),
  use: (hash: string) => answer<BodyUse>(server.GET("/api/humanoids/{content_hash}/use", at(hash))),
  change: (hash: string, change: Partial<BodyChange>) =>
    answer<BodyView>(
      server.PATCH("/api/humanoids/{content_hash}", {
        ...at(hash),
        body: { confirmed: [], ...change },
      }),
    ),
  remove: (hash: string) =>
    answer<undefined>(server.DELETE("/api/humanoids/{content_hash}", at(hash))),
  measure: (hash: string) =>
    answer<BodyView>(server.POST("/api/humanoids/{content_hash}/measure", at(hash))),
  upload: (file: File, onSent: (share: number) => void) =>
    upload<BodyView>(`/api/humanoids?${new URLSearchParams({ name: file.name })}`, [file], onSent),
  fileUrl: (hash: string) => `${address(hash)}/file`,
  /** The model's file as it was uploaded. */
  file: async (hash: string): Promise<ArrayBuffer> =>
    (await fetched(`${address(hash)}/file`)).arrayBuffer(),
  /** Which nodes of the file move with which parts of a body. */
  binding: (hash: string): Promise<BodyBinding> =>
    answer<BodyBinding>(server.GET("/api/humanoids/{content_hash}/binding", at(hash))),
};
