"""Record which messages a headset has sent and which were acknowledged."""

import hashlib
import time
from array import array
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.wire import StreamName
from app.wire.messages import REPORT_STREAM

STREAMS = (StreamName.TARGET.value, StreamName.ACTUAL.value, REPORT_STREAM)
"""The streams in the order of their numbers in the columns."""


@dataclass
class StreamRecord:
    """The messages of one stream: when each was sent (monotonic s), and its latency (s)."""

    ends: "array[int]" = field(default_factory=lambda: array("q"))
    handed_s: "array[float]" = field(default_factory=lambda: array("d"))
    latency_s: "array[float]" = field(default_factory=lambda: array("d"))
    acked: int = 0

    def hand(self, seq_end: int) -> None:
        """Record that a message is passed to the client now."""
        self.ends.append(seq_end)
        self.handed_s.append(time.monotonic())

    def acknowledge(self, next_seq: int, now_s: float) -> None:
        """Record that everything below `next_seq` is on the server's disk."""
        self.acked = max(self.acked, next_seq)
        at = len(self.latency_s)
        while at < len(self.ends) and self.ends[at] <= next_seq:
            self.latency_s.append(now_s - self.handed_s[at])
            at += 1

    @property
    def is_settled(self) -> bool:
        """Return whether every message was acknowledged."""
        return len(self.latency_s) == len(self.ends)


@dataclass
class Digest:
    """A digest of a stream's times, flags and values, independent of how it was batched."""

    times: Any = field(default_factory=hashlib.sha256)
    flags: Any = field(default_factory=hashlib.sha256)
    values: Any = field(default_factory=hashlib.sha256)

    def take(
        self, times_s: NDArray[np.float64], flags: NDArray[np.uint8], values: NDArray[np.float32]
    ) -> None:
        """Add frames to the digest: `times_s` (n,), `flags` (n,), `values` (n, 91)."""
        self.times.update(np.ascontiguousarray(times_s, "<f8"))
        self.flags.update(np.ascontiguousarray(flags, "u1"))
        self.values.update(np.ascontiguousarray(values, "<f4"))

    @property
    def text(self) -> str:
        """Return the digest as text, comparable between processes."""
        return " ".join(one.hexdigest() for one in (self.times, self.flags, self.values))


@dataclass
class Record:
    """The sent and acknowledged messages of one session of the load."""

    session_id: str
    streams: dict[str, StreamRecord] = field(
        default_factory=lambda: {name: StreamRecord() for name in STREAMS}
    )
    digests: dict[str, Digest] = field(default_factory=dict)
    epoch: int = 0
    failure: str | None = None

    def hand(self, stream: str, seq_end: int) -> None:
        """Record that a message is passed to the client now."""
        self.streams[stream].hand(seq_end)

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Record acknowledgements, each given as (stream, epoch, next_seq)."""
        now_s = time.monotonic()
        for stream, epoch, next_seq in positions:
            if epoch == self.epoch:
                self.streams[stream].acknowledge(next_seq, now_s)

    @property
    def is_settled(self) -> bool:
        """Return whether every message was acknowledged."""
        return all(stream.is_settled for stream in self.streams.values())

    def columns(self, number: int) -> NDArray[np.float64]:
        """Return one row per message (n, 4): session, stream, sent (s), latency (s or NaN)."""
        return np.concatenate(
            [_columns(number, code, self.streams[name]) for code, name in enumerate(STREAMS)]
        )

    def summary(self) -> dict[str, Any]:
        """Return counters and digests, for the comparison with the database."""
        return {
            "session_id": self.session_id,
            "epoch": self.epoch,
            "failure": self.failure,
            "handed": {name: one.ends[-1] if one.ends else 0 for name, one in self._named()},
            "acked": {name: one.acked for name, one in self._named()},
            "digests": {name: digest.text for name, digest in self.digests.items()},
        }

    def _named(self) -> Iterable[tuple[str, StreamRecord]]:
        return self.streams.items()


def _columns(number: int, code: int, stream: StreamRecord) -> NDArray[np.float64]:
    rows = np.full((len(stream.ends), 4), np.nan)
    rows[:, 0], rows[:, 1] = number, code
    rows[:, 2] = stream.handed_s
    rows[: len(stream.latency_s), 3] = stream.latency_s
    return rows
