/** One request to the server: JSON in, JSON out, every failure one of `errors.ts`. */
import { errorFromBody, Unreachable } from "./errors";

type Method = "GET" | "POST" | "PUT" | "DELETE";

export async function request<Answer>(
  method: Method,
  path: string,
  body?: unknown,
): Promise<Answer> {
  const response = await reach(method, path, body);
  if (response.status === 204) return undefined as Answer;
  const answer: unknown = await response.json().catch(() => null);
  if (!response.ok) throw errorFromBody(response.status, answer);
  return answer as Answer;
}

/** The response whatever its status; throws `Unreachable` when there is none. */
export async function reach(method: Method, path: string, body?: unknown): Promise<Response> {
  const init: RequestInit = { method, credentials: "same-origin" };
  if (body !== undefined) {
    init.headers = { "content-type": "application/json" };
    init.body = JSON.stringify(body);
  }
  try {
    return await fetch(path, init);
  } catch (cause) {
    throw new Unreachable("The server cannot be reached.", { cause });
  }
}
