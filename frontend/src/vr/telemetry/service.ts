/** The worker's side: a client in a thread of its own, controlled by messages. */
import type { TelemetryClient } from "./client";
import { TelemetryError } from "./failure";
import { openTelemetry } from "./open";
import type { Call, FromWorker, Port, PortError, ToWorker } from "./port";

export function serveTelemetry(port: Port<FromWorker, ToWorker>, open = openTelemetry): void {
  const givenUp = new AbortController();
  const send = (message: FromWorker) => port.postMessage(message, []);
  let client: TelemetryClient | null = null;

  const start = async ({ options, timeOriginMs }: ToWorker & { kind: "open" }) => {
    try {
      client = await open(options, {
        clock: pageClock(timeOriginMs),
        signal: givenUp.signal,
        onStatus: (status) => send({ kind: "status", status }),
      });
    } catch (error) {
      send({ kind: "refused", wrong: portErrorOf(error) });
      return;
    }
    const { welcome, state } = client;
    client.onState((newest) => {
      send({ kind: "state", state: newest, welcome: client?.welcome ?? welcome });
    });
    client.onNotice((notice) => send({ kind: "notice", notice }));
    send({ kind: "opened", welcome, state });
  };

  port.addEventListener("message", ({ data }) => {
    if (data.kind === "open") void start(data);
    else if (data.kind === "giveUp") givenUp.abort();
    else if (client !== null) {
      const { id } = data;
      perform(client, data.call).then(
        () => send({ kind: "done", id, wrong: null }),
        (error) => send({ kind: "done", id, wrong: portErrorOf(error) }),
      );
    }
  });
}

/** The page's `performance.now()` in seconds, read in another thread. */
function pageClock(timeOriginMs: number): () => number {
  const aheadMs = performance.timeOrigin - timeOriginMs;
  return () => (performance.now() + aheadMs) / 1000;
}

async function perform(client: TelemetryClient, call: Call): Promise<void> {
  if (call.what === "sendFrames") await client.sendFrames(call.stream, call.frames);
  else if (call.what === "report") await client.report(call.body);
  else await client[call.what]();
}

function portErrorOf(error: unknown): PortError {
  if (!(error instanceof Error)) return { name: "Error", message: String(error), failure: null };
  const failure = error instanceof TelemetryError ? error.failure : null;
  return { name: error.name, message: error.message, failure };
}
