/**
 * A live feed of the server (server-sent events) that reports whether it is connected.
 *
 * The browser reconnects automatically after a broken connection, but gives up for good after an
 * HTTP
 * error; this feed then opens a new one, waiting a little longer each time.
 */

/** Whether a feed is connected. */
export type FeedState = "connecting" | "live" | "lost";

/** The part of EventSource that is used here, so that tests can replace it. */
export interface Source {
  readonly readyState: number;
  addEventListener(type: string, listener: (event: MessageEvent<string>) => void): void;
  onopen: ((event: Event) => void) | null;
  onerror: ((event: Event) => void) | null;
  close(): void;
}

export interface FeedOptions {
  readonly url: string;
  readonly on: Readonly<Record<string, (data: unknown) => void>>;
  readonly onState: (state: FeedState) => void;
  readonly open?: (url: string) => Source;
}

const CLOSED = 2;
const WAITS_MS = [1000, 2000, 4000, 8000] as const;

/** Open the feed; the returned function closes it for good. */
export function openFeed(options: FeedOptions): () => void {
  const open = options.open ?? ((url: string): Source => new EventSource(url));
  let source: Source | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let failures = 0;

  const connect = () => {
    const opened = open(options.url);
    source = opened;
    opened.onopen = () => {
      failures = 0;
      options.onState("live");
    };
    opened.onerror = () => {
      options.onState("lost");
      if (opened.readyState !== CLOSED) return;
      opened.close();
      timer = setTimeout(connect, WAITS_MS[Math.min(failures, WAITS_MS.length - 1)]);
      failures += 1;
    };
    for (const [type, listener] of Object.entries(options.on)) {
      opened.addEventListener(type, (event) => listener(JSON.parse(event.data)));
    }
  };

  options.onState("connecting");
  connect();
  return () => {
    clearTimeout(timer);
    source?.close();
  };
}
