import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { MalformedMessage } from "./basis";
import { decodeBatch, encodeBatch, MalformedBatch, type StreamName } from "./batch";
import { probedText, textOf } from "./fromClient";
import { serverMessage } from "./fromServer";

const FOLDER = resolve(import.meta.dirname, "../../../../../tests/vectors/wire");

/** The file is made by our own script; its README describes the format. */
const vectorFile = (name: string) =>
  JSON.parse(readFileSync(resolve(FOLDER, `${name}.json`), "utf8"));

interface BatchVector {
  readonly name: string;
  readonly stream: StreamName;
  readonly epoch: number;
  readonly phase_id: number;
  readonly seq_first: number;
  readonly frame_count: number;
  readonly active_s: number;
  readonly closed_at_s: number;
  readonly times_hex: string;
  readonly flags: readonly number[];
  readonly values_hex: string;
  readonly message_hex: string;
}

interface MessageVector {
  readonly name: string;
  readonly text: string;
  readonly message: Record<string, unknown>;
}

const bytesOf = (hex: string): Uint8Array<ArrayBuffer> => Uint8Array.from(Buffer.from(hex, "hex"));
const hexOf = ({ buffer, byteOffset, byteLength }: ArrayBufferView): string =>
  Buffer.from(buffer, byteOffset, byteLength).toString("hex");
const batches: readonly BatchVector[] = vectorFile("batches").batches;

describe("a batch of the vectors", () => {
  it.each(batches)("$name is encoded to the same bytes", (vector) => {
    const message = encodeBatch({
      stream: vector.stream,
      epoch: vector.epoch,
      phaseId: vector.phase_id,
      seqFirst: vector.seq_first,
      activeS: vector.active_s,
      closedAtS: vector.closed_at_s,
      timesS: new Float64Array(bytesOf(vector.times_hex).buffer),
      flags: Uint8Array.from(vector.flags),
      values: new Float32Array(bytesOf(vector.values_hex).buffer),
    });
    expect(hexOf(message)).toBe(vector.message_hex);
  });

  it.each(batches)("$name is decoded to the same fields, bit by bit", (vector) => {
    const batch = decodeBatch(bytesOf(vector.message_hex));
    expect(batch.stream).toBe(vector.stream);
    expect([batch.epoch, batch.phaseId, batch.seqFirst, batch.timesS.length]).toEqual([
      vector.epoch,
      vector.phase_id,
      vector.seq_first,
      vector.frame_count,
    ]);
    expect([batch.activeS, batch.closedAtS]).toEqual([vector.active_s, vector.closed_at_s]);
    expect(hexOf(batch.timesS)).toBe(vector.times_hex);
    expect([...batch.flags]).toEqual(vector.flags);
    expect(hexOf(batch.values)).toBe(vector.values_hex);
  });
});

it.each<{ name: string; message_hex: string }>(vectorFile("refused_batches").batches)(
  "$name is no batch",
  ({ message_hex }) => {
    expect(() => decodeBatch(bytesOf(message_hex))).toThrow(MalformedBatch);
  },
);

/** Whole nanoseconds are compared as the digits in the text. */
const NANOSECONDS = /"(server_(?:received|sent)_ns)": ?(\d+)/g;

describe("a message of the vectors", () => {
  const fromClient: readonly MessageVector[] = vectorFile("messages_from_client").messages;
  const probed = fromClient.filter(({ message }) => message.type === "probed");
  const others = fromClient.filter(({ message }) => message.type !== "probed");

  it.each(others)("$name is written identically by this client", ({ message }) => {
    expect(JSON.parse(textOf(message as Parameters<typeof textOf>[0]))).toEqual(message);
  });

  it("covers an exchange that was answered, and one that was not", () => {
    expect(probed.map(({ name }) => name)).toEqual(["probed", "probed_in_vain"]);
  });

  it.each(probed)("$name is written with every digit", ({ text, message }) => {
    const answered = Object.fromEntries([...text.matchAll(NANOSECONDS)].map((hit) => hit.slice(1)));
    const reading = {
      serverReceivedNs: answered.server_received_ns,
      serverSentNs: answered.server_sent_ns,
      clientReceivedS: Number(message.client_received_s),
    };
    const written = probedText(
      Number(message.client_sent_s),
      message.client_received_s === null ? null : reading,
    );
    expect(JSON.parse(written)).toEqual(message);
    expect([...written.matchAll(NANOSECONDS)].map(([, , ns]) => ns)).toEqual(
      Object.values(answered),
    );
  });

  it.each<MessageVector>(vectorFile("messages_from_server").messages)(
    "$name is understood by this client",
    ({ text }) => {
      const digitsAsText = text.replace(NANOSECONDS, '"$1": "$2"');
      expect(serverMessage(text)).toEqual(JSON.parse(digitsAsText));
    },
  );
});

describe("what the protocol rejects", () => {
  const refused = vectorFile("refused_messages");

  it.each<MessageVector>(refused.from_client.filter(notProbed))("$name is not sent", (vector) => {
    const message = vector.message as Parameters<typeof textOf>[0];
    expect(() => textOf(message)).toThrow(MalformedMessage);
  });

  it.each<MessageVector>(refused.from_server)("$name is not taken over", ({ message }) => {
    expect(() => serverMessage(JSON.stringify(message))).toThrow(MalformedMessage);
  });
});

/** Whether a message is an incomplete reading, which cannot be expressed here at all. */
function notProbed({ message }: MessageVector): boolean {
  return message.type !== "probed";
}
