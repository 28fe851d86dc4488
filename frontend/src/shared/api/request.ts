/** One way to the server: typed by its own description, every failure one of `errors.ts`. */
import createClient from "openapi-fetch";
import { errorFromBody, Unreachable } from "./errors";
import type { paths } from "./schema";

export const server = createClient<paths>({ credentials: "same-origin" });

interface Outcome {
  readonly data?: unknown;
  readonly error?: unknown;
  readonly response: Response;
}

/**
 * The body of an answer. `Body` may tell the described type more exactly, as `types.ts` does.
 *
 * Throws ApiError when the server refuses and Unreachable when there is no answer at all.
 */
export async function answer<Body>(call: Promise<Outcome>): Promise<Body> {
  const { data, error, response } = await call.catch((cause: unknown) => {
    throw new Unreachable("The server cannot be reached.", { cause });
  });
  if (!response.ok) throw errorFromBody(response.status, error);
  return data as Body;
}
