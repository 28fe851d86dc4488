/** Requests for bodies: humanoid models by the hash of their content. */
import type { BodyBinding } from "../stage/skin/pose";
import { errorFromBody, Unreachable } from "./request";

const fetched = async (path: string): Promise<Response> => {
  const response = await fetch(path, { credentials: "same-origin" }).catch((cause: unknown) => {
    throw new Unreachable("The server cannot be reached.", { cause });
  });
  if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
  return response;
};

const address = (hash: string) => `/api/humanoids/${encodeURIComponent(hash)}`;

export const bodies = {
  /** The model's file as it was uploaded. */
  file: async (hash: string): Promise<ArrayBuffer> =>
    (await fetched(`${address(hash)}/file`)).arrayBuffer(),
  /** Which nodes of the file move with which parts of a body. */
  binding: async (hash: string): Promise<BodyBinding> =>
    (await fetched(`${address(hash)}/binding`)).json(),
};
