"""Count the stored frames of each stream by decoding every chunk, without relying on counters."""

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.sessions import canonical
from app.features.record.telemetry import (
    DamagedChunkError,
    Frames,
    Piece,
    decode_piece,
    iter_pieces,
)
from app.models import ClientReport, TelemetryStream
from app.wire import MAX_TIME_S, PARTICIPANT_STREAMS, REPORT_STREAM


@dataclass(frozen=True)
class StreamReceipt:
    """The stored and the missing frames (or reports) of one stream in one epoch.

    `sent`: how many frames (or reports) the client made, as far as it could report it. `gaps`: the
    seqs that are missing, as (first, end). `damaged`: stored frames that can no longer be decoded;
    they count as missing. `flagged`: frames with values that no summary uses. `backwards`: readable
    frames that are not later than the previous one, or whose time is not a number. `sha256` covers
    every bit of every readable frame in order of seq, so two copies of a record can be compared.
    Of the avatar's streams, both it and `flagged` are null for readers who must not know the
    condition (`blinded`).
    """

    stream: str
    epoch: int
    sent: int
    stored: int
    missing: int
    gaps: tuple[tuple[int, int], ...]
    damaged: int
    flagged: int | None
    backwards: int
    sha256: str | None

    def blinded(self) -> Self:
        """Return the receipt as readers may see it who must not know the condition.

        Of a delayed copy without delay the avatar's frames are the participant's own, bit by bit,
        so one hash beside the other would tell. How often a body's simulation fails depends on its
        settings and its latency. The participant's own frames keep both.
        """
        if self.stream in PARTICIPANT_STREAMS:
            return self
        flagged = self.flagged if self.stream == REPORT_STREAM else None
        return replace(self, sha256=None, flagged=flagged)


@dataclass
class _Count:
    """The running counts of one stream."""

    next_seq: int = 0
    stored: int = 0
    damaged: int = 0
    gaps: list[tuple[int, int]] = field(default_factory=list)
    backwards: int = 0
    newest_s: float = -np.inf

    def timed(self, times_s: NDArray[np.float64]) -> None:
        """Count those of the next frames' times that run backwards or are invalid."""
        valid_s = np.where(np.abs(times_s) <= MAX_TIME_S, times_s, np.nan)
        newest_s = np.fmax.accumulate(np.concatenate(([self.newest_s], valid_s)))
        # A comparison with NaN is false, so an invalid time is counted, too.
        self.backwards += int((~(newest_s[:-1] < valid_s)).sum())
        self.newest_s = float(newest_s[-1])

    def found(self, seq_first: int, count: int, *, readable: bool = True) -> None:
        """Count `count` seqs from `seq_first` on as stored, or as damaged if not `readable`."""
        if seq_first > self.next_seq:
            self.gaps.append((self.next_seq, seq_first))
        self.next_seq = seq_first + count
        self.stored += count if readable else 0
        self.damaged += 0 if readable else count
        if not readable:
            self.gaps.append((seq_first, self.next_seq))

    def until(self, sent: int) -> None:
        """Count everything from here up to `sent` as missing."""
        if self.next_seq < sent:
            self.gaps.append((self.next_seq, sent))


@dataclass
class StreamTally:
    """Counts the pieces of one stream in one epoch, given in order of seq."""

    count: _Count = field(default_factory=_Count)
    digest: "hashlib._Hash" = field(default_factory=hashlib.sha256)

    def add(self, piece: Piece, frames: Frames | None) -> None:
        """Count a piece with its decoded frames, None if it is damaged."""
        self.count.found(piece.seq_first, piece.frame_count, readable=frames is not None)
        if frames is not None:
            self.count.timed(frames.times_s)
            self.digest.update(frame_bytes(frames, piece.phase_id))


class Tallies:
    """Counts the streams of a session while somebody else reads all of their frames.

    Opening the chunks takes most of a receipt's time, so whoever reads the frames anyway, in the
    same transaction, can let them be counted on the way.
    """

    def __init__(self) -> None:
        self._streams: dict[tuple[str, int], StreamTally] = {}

    def of(self, stream: str, epoch: int) -> Callable[[Piece, Frames | None], None]:
        """Return what must be told every piece of a stream and epoch, as `iter_frames` does."""

        def told(piece: Piece, frames: Frames | None) -> None:
            # Created with the first piece: of a stream that nobody reads nothing is known.
            self._streams.setdefault((stream, epoch), StreamTally()).add(piece, frames)

        return told

    def found(self, stream: str, epoch: int) -> StreamTally | None:
        """Return the counts of a stream and epoch; None if nothing of it was read."""
        return self._streams.get((stream, epoch))


def stream_receipts(
    db: Session, session_id: str, tallies: Tallies | None = None
) -> tuple[StreamReceipt, ...]:
    """Return a receipt for every stream of a session, sorted by epoch.

    Streams that `tallies` has counted are not read again.
    """
    rows = db.scalars(
        select(TelemetryStream)
        .where(TelemetryStream.session_id == session_id)
        .order_by(TelemetryStream.epoch, TelemetryStream.stream)
    ).all()
    known = tallies or Tallies()
    return tuple(
        _stream_receipt(row, known.found(row.stream, row.epoch) or _counted(db, row))
        for row in rows
    )


def _stream_receipt(row: TelemetryStream, tally: StreamTally) -> StreamReceipt:
    count = tally.count
    sent = max(row.produced, row.next_seq, count.next_seq)
    count.until(sent)
    return StreamReceipt(
        stream=row.stream,
        epoch=row.epoch,
        sent=sent,
        stored=count.stored,
        missing=sent - count.stored,
        gaps=tuple(count.gaps),
        damaged=count.damaged,
        flagged=row.frames_flagged,
        backwards=count.backwards,
        sha256=tally.digest.hexdigest(),
    )


def _counted(db: Session, row: TelemetryStream) -> StreamTally:
    tally = StreamTally()
    if row.stream == REPORT_STREAM:
        _count_reports(db, row, tally)
        return tally
    for piece in iter_pieces(db, row.session_id, row.stream, row.epoch):
        try:
            frames = decode_piece(piece)
        except DamagedChunkError:
            frames = None
        tally.add(piece, frames)
    return tally


def frame_bytes(frames: Frames, phase_id: int) -> bytes:
    """Return every bit of the frames row by row, regardless of how they were split into chunks.

    A row: phase_id u32, time f64, flags u8, values f32, little-endian.
    """
    n = len(frames)
    columns: Iterable[np.ndarray[tuple[int, ...], np.dtype[np.uint8]]] = (
        np.full(n, phase_id, "<u4").view(np.uint8).reshape(n, 4),
        np.ascontiguousarray(frames.times_s, "<f8").view(np.uint8).reshape(n, 8),
        frames.flags.reshape(n, 1),
        np.ascontiguousarray(frames.values, "<f4").view(np.uint8).reshape(n, -1),
    )
    return np.hstack(list(columns)).tobytes()


def _count_reports(db: Session, row: TelemetryStream, tally: StreamTally) -> None:
    reports = db.execute(
        select(ClientReport.seq, ClientReport.payload)
        .where(ClientReport.session_id == row.session_id, ClientReport.epoch == row.epoch)
        .order_by(ClientReport.seq)
    )
    for seq, payload in reports:
        tally.count.found(seq, 1)
        tally.digest.update(canonical(payload).encode())
