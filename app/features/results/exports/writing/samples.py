"""Write the frames of a session as one wide CSV while they are read.

A session of eight minutes has eight million numbers, so they are printed by one call per piece: the
JSON writer of pydantic prints numbers, true, false and null in C, and without their brackets its
lists are CSV rows. These files contain only numbers and fixed words, so no cell needs quotes.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from pydantic_core import to_json
from sqlalchemy.orm import Session

from app.features.record.receipts import Tallies
from app.features.record.telemetry import epochs_of, iter_frames
from app.features.results.analysis.codebook import columns_of
from app.features.results.exports.writing.pairing import Rows, Side, paired_rows
from app.wire import BODY_STREAMS, FINGER_STREAMS, StreamName, flag_frames

ACTIVE_BIT = 1


@dataclass(frozen=True)
class SampleFile:
    """The samples file of a session, read from the database while it is written.

    `blinded`: without the avatar's frames, which lag behind the participant's by the latency.
    `fingers`: of the fingers instead of the body. `tallies` count the frames that are written, for
    the session's receipt.
    """

    db: Session
    session_id: str
    simulated: bool
    avatar: str
    blinded: bool = False
    fingers: bool = False
    tallies: Tallies = field(default_factory=Tallies)

    def pieces(self) -> Iterator[bytes]:
        """Yield the file in pieces of about a second of movement."""
        table = "fingers" if self.fingers else "samples"
        yield (",".join(column.name for column in columns_of(table)) + "\n").encode()
        start = f"{'true' if self.simulated else 'false'},{self.avatar},"
        for epoch in self._epochs():
            target, actual = (
                iter_frames(
                    *(self.db, self.session_id, stream, epoch),
                    told=self.tallies.of(stream, epoch),
                )
                for stream in self._streams
            )
            if self.blinded:
                actual = iter(())
            for rows in paired_rows(target, actual):
                yield _csv(rows, f"{start}{epoch},".encode(), self._missing)

    @property
    def _streams(self) -> tuple[StreamName, StreamName]:
        return FINGER_STREAMS if self.fingers else BODY_STREAMS

    @property
    def _missing(self) -> list[float | None]:
        return [None] * self._streams[0].values_per_frame

    def _epochs(self) -> list[int]:
        return sorted(
            {e for stream in self._streams for e in epochs_of(self.db, self.session_id, stream)}
        )


def _csv(rows: Rows, start: bytes, missing: list[float | None]) -> bytes:
    head = _head(rows)
    table = [
        [*own, *target, *actual]
        for own, target, actual in zip(
            head, _values(rows.target, missing), _values(rows.actual, missing), strict=True
        )
    ]
    text = to_json(table, inf_nan_mode="constants")[2:-2]
    if not (rows.target.present.all() and rows.actual.present.all()):
        text = text.replace(b"null", b"")
    return start + text.replace(b"],[", b"\n" + start) + b"\n"


def _head(rows: Rows) -> list[tuple[int, int, float, bool, bool]]:
    """Return each row's seq, phase_id, t_s, active and flagged, if possible from the target."""
    count = len(rows.seq)
    phase_id = np.zeros(count, np.int64)
    t_s = np.zeros(count)
    active = np.zeros(count, np.bool_)
    flagged = np.zeros(count, np.bool_)
    for side in (rows.actual, rows.target):
        phase_id[side.present] = side.phase_id
        t_s[side.present] = side.times_s
        active[side.present] = (side.flags & ACTIVE_BIT) > 0
        if len(side.values):
            flagged[side.present] |= flag_frames(side.times_s, side.values).bad
    columns = (rows.seq, phase_id, t_s, active, flagged)
    return list(zip(*(column.tolist() for column in columns), strict=True))


def _values(side: Side, missing: list[float | None]) -> list[list[float | None]]:
    """Return the numbers of each row; the cells are empty where the stream has no frame."""
    if not len(side.values):
        return [missing] * len(side.present)
    from app.features.results.exports.writing.shortest import shortest_doubles

    own = iter(shortest_doubles(side.values).tolist())
    return [next(own) if present else missing for present in side.present.tolist()]
