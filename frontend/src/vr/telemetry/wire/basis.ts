/**
 * Numbers and names that both directions of the protocol share, with the limits the server sets.
 */
import * as v from "valibot";

export const PROTOCOL_VERSION = 1;
export const SUBPROTOCOL = "reembody.v1";
/** The stream of the reports, in addition to those of the frames. */
export const REPORT_STREAM = "reports";

const whole = (least: number, most: number) =>
  v.pipe(v.number(), v.safeInteger(), v.minValue(least), v.maxValue(most));

const name = (longest: number) =>
  v.pipe(
    v.string(),
    v.maxLength(longest),
    // Not every database accepts a NUL in a text.
    v.check((text) => !text.includes("\0"), "a name must not hold the character NUL"),
  );

/** Seconds of the client's monotonic clock, or a duration. */
export const Seconds = v.pipe(v.number(), v.finite(), v.minValue(0), v.maxValue(1e9));
export const Seq = whole(0, Number.MAX_SAFE_INTEGER);
export const Epoch = whole(1, 2 ** 31 - 1);
export const Count = whole(0, 2 ** 31 - 1);
export const Name20 = name(20);
export const Name40 = name(40);
export const Name120 = name(120);
export const Name300 = name(300);
export const CompletionNumber = whole(1, 10_000);

/**
 * Thrown for a value that one side sent and the other cannot use; the message says where and why.
 */
export class MalformedMessage extends Error {
  override readonly name = "MalformedMessage";
}

/** The value as the schema's type; MalformedMessage names the first field that does not fit. */
export function narrowed<Schema extends v.GenericSchema>(
  schema: Schema,
  value: unknown,
): v.InferOutput<Schema> {
  const result = v.safeParse(schema, value, { abortEarly: true });
  if (result.success) return result.output;
  const [issue] = result.issues;
  throw new MalformedMessage(`${issue.message} at ${v.getDotPath(issue) ?? "the message itself"}`);
}
