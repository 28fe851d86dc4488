"""Join two streams frame by frame, on equal seq, in pieces and with constant memory."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry import Frames

Piece = tuple[int, Frames]
"""A phase_id with consecutive frames of one stream."""


@dataclass(frozen=True)
class Side:
    """One stream's part of a piece of n rows.

    `present` (n,) marks the rows in which it has a frame; the other arrays contain only those
    frames.
    """

    present: NDArray[np.bool_]
    phase_id: NDArray[np.int64]
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]


@dataclass(frozen=True)
class Rows:
    """n rows in order of `seq` (n,), each with a frame of at least one of the two streams."""

    seq: NDArray[np.int64]
    target: Side
    actual: Side


def paired_rows(target: Iterator[Piece], actual: Iterator[Piece]) -> Iterator[Rows]:
    """Join the pieces of two streams of one epoch, each in order of seq.

    Rows are yielded as soon as neither stream can have an earlier one, so at most one piece of each
    is in memory, however far apart the streams are.
    """
    left, right = _Buffer(target), _Buffer(actual)
    while left.fill() | right.fill():
        # An exhausted stream does not limit the rows.
        until = min(buffer.last_seq for buffer in (left, right) if buffer.frames is not None)
        yield _joined(left.take(until), right.take(until))


class _Buffer:
    """The current piece of a stream, without the frames that were taken from it."""

    def __init__(self, pieces: Iterator[Piece]) -> None:
        self._pieces = pieces
        self.phase_id = 0
        self.frames: Frames | None = None

    @property
    def last_seq(self) -> int:
        """Return the seq of the last buffered frame, -1 if there is none."""
        return -1 if self.frames is None else int(self.frames.seq[-1])

    def fill(self) -> bool:
        """Load the next piece if the buffer is empty; return whether there are frames."""
        while self.frames is None or len(self.frames) == 0:
            self.frames = None
            piece = next(self._pieces, None)
            if piece is None:
                return False
            self.phase_id, self.frames = piece
        return True

    def take(self, until_seq: int) -> Piece:
        """Remove and return the frames up to and including `until_seq`."""
        if self.frames is None:
            return self.phase_id, _NONE
        count = int(np.searchsorted(self.frames.seq, until_seq, side="right"))
        taken, self.frames = _part(self.frames, 0, count), _part(self.frames, count, None)
        return self.phase_id, taken


def _part(frames: Frames, begin: int, end: int | None) -> Frames:
    rows = slice(begin, end)
    return Frames(frames.seq[rows], frames.times_s[rows], frames.flags[rows], frames.values[rows])


_NONE = Frames(
    seq=np.empty(0, np.int64),
    times_s=np.empty(0),
    flags=np.empty(0, np.uint8),
    values=np.empty((0, 0), np.float32),
)


def _joined(target: Piece, actual: Piece) -> Rows:
    seq = np.union1d(target[1].seq, actual[1].seq)
    return Rows(seq, _side(seq, target), _side(seq, actual))


def _side(seq: NDArray[np.int64], piece: Piece) -> Side:
    phase_id, frames = piece
    return Side(
        present=np.isin(seq, frames.seq, assume_unique=True),
        phase_id=np.full(len(frames), phase_id),
        times_s=frames.times_s,
        flags=frames.flags,
        values=frames.values,
    )
