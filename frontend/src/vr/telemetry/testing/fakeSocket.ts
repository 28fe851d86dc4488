/** What the client uses of a WebSocket. Everything arrives in a later turn, as from a network. */
export class FakeSocket {
  readonly protocols: readonly string[];
  readyState: number = WebSocket.CONNECTING;
  binaryType = "blob";
  bufferedAmount = 0;
  /** A network that takes nothing: what is sent stays in the browser. */
  isStuck = false;
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: { code: number; reason: string }) => void) | null = null;
  readonly #sent: (data: string | Uint8Array<ArrayBuffer>) => void;

  constructor(
    protocols: readonly string[],
    sent: (data: string | Uint8Array<ArrayBuffer>) => void,
  ) {
    this.protocols = protocols;
    this.#sent = sent;
  }

  send(data: string | Uint8Array<ArrayBuffer>): void {
    if (this.isStuck) this.bufferedAmount += data.length;
    else queueMicrotask(() => this.#sent(data));
  }

  close(code = 1005, reason = ""): void {
    this.breaks(code, reason);
  }

  opens(): void {
    this.readyState = WebSocket.OPEN;
    this.onopen?.();
  }

  hears(text: string): void {
    queueMicrotask(() => this.onmessage?.({ data: text }));
  }

  breaks(code = 1006, reason = ""): void {
    this.readyState = WebSocket.CLOSED;
    queueMicrotask(() => this.onclose?.({ code, reason }));
  }
}
