/** Every number that decides when the client waits, gives up or retries. */
export interface Limits {
  /** The producer waits while the journal contains this many bytes. */
  readonly journalBytes: number;
  /** The producer waits while so many bytes are not yet written to the journal's disk. */
  readonly memoryBytes: number;
  /**
   * Messages are written to disk together, at most this often; a crash while offline can lose this
   * much.
   */
  readonly flushEveryS: number;
  /** Or as soon as so many bytes have accumulated. */
  readonly flushBytes: number;
  /**
   * Messages are stored on disk in blocks of about this many bytes. Chromium stores values of more
   * than 64 KiB in separate files, which cost much more.
   */
  readonly blockBytes: number;
  /** How many blocks are read ahead when old messages are resent. */
  readonly blocksAhead: number;
  /** The fraction of the browser's remaining space that the journal leaves unused. */
  readonly quotaReserve: number;
  /** Most frames in one batch: the server takes messages of up to 256 KiB, which is 702 frames. */
  readonly framesPerBatch: number;
  /** Sending pauses while the browser's send buffer contains more than so many bytes. */
  readonly bufferedBytes: number;
  /** How often the buffer is checked during such a pause. */
  readonly bufferPollS: number;
  /** Pauses between attempts to connect; the last one repeats. */
  readonly retryS: readonly number[];
  /** A connection must be welcomed within this time. */
  readonly openTimeoutS: number;
  /**
   * A connection on which nothing is received for this long is dead; probes are answered every
   * second.
   */
  readonly silenceS: number;
  /** Requests to resend the same gap within this time count as one. */
  readonly resendPauseS: number;
  /** After so many attempts to fill a gap it is clear that the journal cannot. */
  readonly resendAttempts: number;
  readonly probeEveryS: number;
  /** A probe whose answer takes longer is reported as null. */
  readonly probeTimeoutS: number;
  readonly producedEveryS: number;
  /** The client is behind once its oldest unacknowledged message is this old. */
  readonly behindAfterS: number;
  /** How long to wait for another page that has the same journal open. */
  readonly lockTimeoutS: number;
}

export const DEFAULT_LIMITS: Limits = {
  journalBytes: 256 * 1024 * 1024,
  memoryBytes: 4 * 1024 * 1024,
  flushEveryS: 0.25,
  flushBytes: 512 * 1024,
  blockBytes: 48 * 1024,
  blocksAhead: 8,
  quotaReserve: 0.1,
  framesPerBatch: 512,
  bufferedBytes: 256 * 1024,
  bufferPollS: 0.01,
  retryS: [0.1, 0.2, 0.5, 1],
  openTimeoutS: 10,
  silenceS: 6,
  resendPauseS: 1,
  resendAttempts: 5,
  probeEveryS: 1,
  probeTimeoutS: 2,
  producedEveryS: 1,
  behindAfterS: 2,
  lockTimeoutS: 5,
};
