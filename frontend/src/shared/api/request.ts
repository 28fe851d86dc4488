/**
 * The single way to the server, typed by its OpenAPI description; failures are ApiError or
 * Unreachable.
 */
import createClient from "openapi-fetch";
import type { paths } from "./schema";

export const server = createClient<paths>({ credentials: "same-origin" });

// All tabs of a browser share one cookie: if somebody else signs in in another tab, it answers this
// one, too. So each request names the account that the page shows, and the server refuses others.
server.use({
  onRequest({ request }) {
    for (const [name, value] of Object.entries(accountHeader())) request.headers.set(name, value);
  },
});

const accountListeners = new Set<() => void>();
let pageAccount: string | null = null;

/** The id of the account that this page shows; null if nobody has signed in on it. */
export const accountOfPage = (): string | null => pageAccount;

/** Set the account that this page shows: only answers to this account are for it. */
export function setAccountOfPage(id: string | null): void {
  pageAccount = id;
}

/** The header that a request made without `server` has to have, too. */
export const accountHeader = (): Readonly<Record<string, string>> =>
  pageAccount === null ? {} : { "x-reembody-account": pageAccount };

/** Hear when the server refuses a request since another account has signed in in this browser. */
export function onOtherAccount(listener: () => void): () => void {
  accountListeners.add(listener);
  return () => accountListeners.delete(listener);
}

interface Outcome {
  readonly data?: unknown;
  readonly error?: unknown;
  readonly response: Response;
}

/**
 * Return the body of a response. `Body` may narrow the described type, as `types.ts` does.
 *
 * Throws ApiError if the server returns an error and Unreachable if there is no response.
 */
export async function answer<Body>(call: Promise<Outcome>): Promise<Body> {
  const { data, error, response } = await call.catch((cause: unknown) => {
    throw new Unreachable("The server cannot be reached.", { cause });
  });
  if (!response.ok) throw errorFromBody(response.status, error);
  return data as Body;
}

// What can go wrong between this page and the server:
//
//     Failure
//     |- ApiError        the server answered and said what is wrong and what to do
//     |- Unreachable     no answer: the network, or the server is not running
//     `- FileChanged     nothing was sent: the file is not what it was when it was chosen

export interface Problem {
  readonly path?: string | null;
  readonly line?: number | null;
  readonly column?: number | null;
  readonly message: string;
  readonly value?: unknown;
  readonly valid?: unknown;
  readonly remedy?: string | null;
}

interface ErrorBody {
  readonly code: string;
  readonly message: string;
  readonly value?: unknown;
  readonly valid?: unknown;
  readonly remedy?: string | null;
  readonly details?: readonly Problem[] | null;
}

export class ApiError extends Error {
  override readonly name = "ApiError";
  readonly code: string;
  readonly remedy: string | null;
  readonly value: unknown;
  readonly valid: unknown;
  readonly details: readonly Problem[];

  constructor(
    readonly status: number,
    body: ErrorBody,
  ) {
    super(body.message);
    this.code = body.code;
    this.remedy = body.remedy ?? null;
    this.value = body.value;
    this.valid = body.valid;
    this.details = body.details ?? [];
  }
}

export class Unreachable extends Error {
  override readonly name = "Unreachable";
}

/** The file was changed or removed after it was chosen, and the browser does not read it then. */
export class FileChanged extends Error {
  override readonly name = "FileChanged";

  constructor(readonly fileName: string) {
    super(`${fileName} has changed since it was chosen.`);
  }
}

/**
 * Why files were not sent: a browser reports a changed file like a server that does not answer, so
 * a byte of each is read.
 */
export async function whyNotSent(
  files: readonly File[],
  cause?: unknown,
): Promise<FileChanged | Unreachable> {
  for (const file of files) {
    try {
      await file.slice(0, 1).arrayBuffer();
    } catch {
      return new FileChanged(file.name);
    }
  }
  return new Unreachable("The server cannot be reached.", { cause });
}

/** The bytes of a chosen file; throws FileChanged if it is not what it was then. */
export const bytesOf = (file: File): Promise<ArrayBuffer> =>
  file.arrayBuffer().catch(() => {
    throw new FileChanged(file.name);
  });

/** The text of a chosen file; throws FileChanged if it is not what it was then. */
export const textOf = (file: File): Promise<string> =>
  file.text().catch(() => {
    throw new FileChanged(file.name);
  });

/**
 * The error in a response body, or a generic one if a proxy or a crash answered instead. Tells the
 * listeners of `onOtherAccount` if it is theirs.
 */
export function errorFromBody(status: number, body: unknown): ApiError {
  const error = (body as { error?: Partial<ErrorBody> } | null)?.error;
  if (error?.code === "other_account") for (const listener of accountListeners) listener();
  if (typeof error?.code === "string" && typeof error.message === "string") {
    return new ApiError(status, error as ErrorBody);
  }
  return new ApiError(status, {
    code: `http_${status}`,
    message: `The server answered with status ${status}.`,
    remedy: "Try again. If the problem persists, see the server's log.",
  });
}

export const isApiError = (error: unknown, code?: string): error is ApiError =>
  error instanceof ApiError && (code === undefined || error.code === code);

export const isUnauthorised = (error: unknown): boolean =>
  error instanceof ApiError && error.status === 401;
