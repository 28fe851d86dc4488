/** Every number that decides when the client waits, gives up or tries again. */
export interface Limits {
  /** The producer waits while the journal holds this many bytes. */
  readonly journalBytes: number;
  /** The producer waits while so many bytes are not written to the journal's disk yet. */
  readonly memoryBytes: number;
  /** Messages go to disk together, at most this often; a crash while offline can cost so much. */
  readonly flushEveryS: number;
  /** Or as soon as so many bytes have gathered. */
  readonly flushBytes: number;
  /**
   * Messages lie on disk in blocks of about so many bytes. Chromium keeps values of more than 64 KiB
   * in files of their own, which cost much more.
   */
  readonly blockBytes: number;
  /** How many blocks are read ahead when an old message is sent again. */
  readonly blocksAhead: number;
  /** What the browser may still store that the journal leaves untouched, as a share. */
  readonly quotaReserve: number;
  /** Most frames in one batch: the server takes messages of up to 256 KiB, which is 702 frames. */
  readonly framesPerBatch: number;
  /** Sending pauses while the browser holds so many bytes that the network has not taken. */
  readonly bufferedBytes: number;
  /** How often the buffer is looked at then. */
  readonly bufferPollS: number;
  /** Pauses between attempts to connect; the last one repeats. */
  readonly retryS: readonly number[];
  /** A connection must be welcomed within this time. */
  readonly openTimeoutS: number;
  /** A connection on which nothing is heard for so long is dead; probes are answered every second. */
  readonly silenceS: number;
  /** A hole that the server asks for again sooner than this is the same one. */
  readonly resendPauseS: number;
  /** After so many attempts to fill a hole it is clear that the journal cannot. */
  readonly resendAttempts: number;
  readonly probeEveryS: number;
  /** An answer that takes longer is told as null. */
  readonly probeTimeoutS: number;
  readonly producedEveryS: number;
  /** From this age of the oldest unacknowledged message on, the client is behind. */
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
