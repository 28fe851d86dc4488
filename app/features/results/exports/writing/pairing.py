"""Two streams side by side: frames with the same seq in one row, in pieces, in constant memory."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry import Frames

Piece = tuple[int, Frames]
"""A phase_id and consecutive frames of one stream."""


@dataclass(frozen=True)
class Side:
    """One stream's part of a piece of n rows.

    `present` (n,) says in which rows it has a frame; the other arrays hold only those frames.
    """

    present: NDArray[np.bool_]
    phase_id: NDArray[np.int64]
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]


@dataclass(frozen=True)
class Rows:
    """n rows in order of `seq` (n,), each with a frame of the target, the actual stream or both."""

    seq: NDArray[np.int64]
    target: Side
    actual: Side


def paired_rows(target: Iterator[Piece], actual: Iterator[Piece]) -> Iterator[Rows]:
    """Join the pieces of two streams of one epoch, each in order of seq.

    Rows are given as soon as neither stream can have an earlier one, so at most one piece of each
    is held, however far apart the streams are.
    """
    left, right = _Buffer(target), _Buffer(actual)
    while left.fill() | right.fill():
        # An exhausted stream holds nothing back.
        until = min(buffer.last_seq for buffer in (left, right) if buffer.frames is not None)
        yield _joined(left.take(until), right.take(until))


class _Buffer:
    """The piece of a stream that is being used up."""

    def __init__(self, pieces: Iterator[Piece]) -> None:
        self._pieces = pieces
        self.phase_id = 0
        self.frames: Frames | None = None

    @property
    def last_seq(self) -> int:
        """Seq of the last frame held."""
        return -1 if self.frames is None else int(self.frames.seq[-1])

    def fill(self) -> bool:
        """Hold the next piece if none is left; whether there is one."""
        while self.frames is None or len(self.frames) == 0:
            self.frames = None
            piece = next(self._pieces, None)
            if piece is None:
                return False
            self.phase_id, self.frames = piece
        return True

    def take(self, until_seq: int) -> Piece:
        """The frames up to and with `until_seq`; they are held no longer."""
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
