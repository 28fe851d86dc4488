/** A WebSocket that reconnects by itself, and answers each picture that was drawn from it. */

const WAITS_MS = [500, 1000, 2000, 4000] as const;

export interface LiveSocket {
  /** Acknowledge that so many poses were drawn, or skipped in favour of newer ones. */
  readonly drawn: (count: number) => void;
  readonly close: () => void;
}

export interface LiveSocketOptions {
  /** The socket's path on this server. */
  readonly url: string;
  /** Close codes after which trying again would not help. */
  readonly refused: readonly number[];
  readonly onMessage: (data: unknown) => void;
  readonly onLost: () => void;
  readonly open?: ((url: string) => WebSocket) | undefined;
}

export function openLiveSocket(options: LiveSocketOptions): LiveSocket {
  const open = options.open ?? ((url: string) => new WebSocket(socketUrl(url)));
  let socket: WebSocket | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let failures = 0;
  let closed = false;
  const connect = () => {
    const opened = open(options.url);
    opened.binaryType = "arraybuffer";
    socket = opened;
    opened.onmessage = ({ data }) => {
      failures = 0;
      options.onMessage(data);
    };
    opened.onclose = ({ code }) => {
      if (closed) return;
      options.onLost();
      if (options.refused.includes(code)) return;
      timer = setTimeout(connect, WAITS_MS[Math.min(failures, WAITS_MS.length - 1)]);
      failures += 1;
    };
  };
  connect();
  return {
    drawn: (count) => {
      if (socket?.readyState !== 1) return;
      for (let one = 0; one < count; one++) socket.send("");
    },
    close: () => {
      closed = true;
      clearTimeout(timer);
      socket?.close();
    },
  };
}

/** The WebSocket's URL with its scheme, since not every browser accepts a relative one. */
function socketUrl(path: string): string {
  const url = new URL(path, location.href);
  url.protocol = url.protocol.replace("http", "ws");
  return url.href;
}
