/**
 * The avatars of a session, as the server builds and records them for this participant, and the
 * models that they are drawn with.
 */
import { answer, errorFromBody, server, Unreachable } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import type { BodyBinding } from "@shared/stage/skin/pose";
import { readBody } from "@shared/stage/skin/readBody";
import type { Measures } from "../calibration";

export type SessionAvatar = components["schemas"]["SessionAvatar"];
/** By name of the body; null is the body of the avatar's configuration. */
export type Avatars = ReadonlyMap<string | null, SessionAvatar>;

/**
 * Request the avatar of the configuration and of every body that the study's conditions name.
 *
 * All are requested at once, before the first is worn, so that neither the time nor the kind of a
 * request reveals which comes next. Throws ApiError or Unreachable.
 */
export async function requestAvatars(
  token: string,
  { statureM, segmentsM }: Measures,
  named: readonly string[],
): Promise<Avatars> {
  const request = async (body: string | null): Promise<[string | null, SessionAvatar]> => {
    const avatar = await answer<SessionAvatar>(
      server.POST("/api/vr/avatar", {
        headers: bearer(token),
        body: { stature_m: statureM, body, segments_m: { ...segmentsM } },
      }),
    );
    return [body, avatar];
  };
  return new Map(await Promise.all([null, ...named].map(request)));
}

/** Load the model that an avatar is drawn with, by the hash of its content. */
export async function loadModel(token: string, hash: string): Promise<BodyModel> {
  const at = `/api/vr/bodies/${encodeURIComponent(hash)}`;
  const [file, binding] = await Promise.all([
    fetched(`${at}/file`, token).then((response) => response.arrayBuffer()),
    fetched(`${at}/binding`, token).then((response) => response.json() as Promise<BodyBinding>),
  ]);
  return readBody(file, binding);
}

async function fetched(path: string, token: string): Promise<Response> {
  const response = await fetch(path, { headers: bearer(token) }).catch((cause: unknown) => {
    throw new Unreachable("The server cannot be reached.", { cause });
  });
  if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
  return response;
}

const bearer = (token: string): Readonly<Record<string, string>> => ({
  authorization: `Bearer ${token}`,
});
