/** A download that shows its progress and can be cancelled. */
import { accountHeader, errorFromBody, Unreachable } from "@shared/api/request";
import { saveFile } from "@shared/saveFile";
import { useRef, useState } from "react";

export type DownloadState =
  | { readonly phase: "idle" }
  | { readonly phase: "running"; readonly received: number; readonly total: number | null }
  | { readonly phase: "done"; readonly received: number; readonly name: string }
  | { readonly phase: "failed"; readonly error: unknown };

interface Download {
  readonly state: DownloadState;
  readonly start: (url: string, name: string) => Promise<void>;
  readonly stop: () => void;
}

export function useDownload(): Download {
  const [state, setState] = useState<DownloadState>({ phase: "idle" });
  const running = useRef<AbortController | null>(null);
  const start = async (url: string, name: string) => {
    const control = new AbortController();
    running.current = control;
    setState({ phase: "running", received: 0, total: null });
    try {
      const blob = await receive(url, control.signal, (received, total) =>
        setState({ phase: "running", received, total }),
      );
      save(blob, name);
      setState({ phase: "done", received: blob.size, name });
    } catch (error) {
      setState(control.signal.aborted ? { phase: "idle" } : { phase: "failed", error });
    }
  };
  return { state, start, stop: () => running.current?.abort() };
}

async function receive(
  url: string,
  signal: AbortSignal,
  onProgress: (received: number, total: number | null) => void,
): Promise<Blob> {
  const response = await fetch(url, { signal, headers: accountHeader() }).catch(
    (cause: unknown) => {
      throw new Unreachable("The server cannot be reached.", { cause });
    },
  );
  if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
  const length = response.headers.get("content-length");
  const total = length === null ? null : Number(length);
  const chunks: Uint8Array<ArrayBuffer>[] = [];
  let received = 0;
  for (const reader = response.body?.getReader(); reader !== undefined; ) {
    const { done, value } = await reader.read();
    if (done) break;
    chunks.push(value);
    received += value.length;
    onProgress(received, total);
  }
  return new Blob(chunks, { type: response.headers.get("content-type") ?? "application/zip" });
}

function save(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  saveFile(address, name);
  // The browser reads the file after the click; revoking the URL immediately would cut it off.
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}
