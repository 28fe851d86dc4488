"""Write the frames of a session as one wide CSV while they are read.

A session of eight minutes has eight million numbers, so they are printed by one call per piece: the
JSON writer of pydantic prints numbers, true, false and null in C, and without their brackets its
lists are CSV rows. These files contain only numbers and fixed words, so no cell needs quotes.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json
from sqlalchemy.orm import Session

from app.features.record.receipts import Tallies
from app.features.record.telemetry import epochs_of, iter_frames
from app.features.results.analysis.codebook import columns_of
from app.features.results.exports.writing.pairing import Rows, Side, paired_rows
from app.wire import BODY_STREAMS, FINGER_STREAMS, StreamName, flag_frames

_POWERS = 10.0 ** np.arange(23)
"""Powers of ten, exact in double precision up to 10^22, so a quotient is rounded only once."""
_HIGH = np.array([float(10**power) for power in range(48)])
_LOW = np.array([float(10**power - int(float(10**power))) for power in range(48)])
"""Higher powers of ten as sums of two doubles."""
_SPLITTER = 2.0**27 + 1.0
_MIN_DIGITS, _MAX_DIGITS = 6, 9
ACTIVE_BIT = 1


def shortest_doubles(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the doubles, of the same shape, whose shortest text is that of the single `values`.

    0.1 in single precision is 0.100000001490116..., but "0.1" already identifies it. Six
    significant digits identify at most one single-precision number, nine always suffice (Steele and
    White 1990), so each value is rounded to 6, 7, 8 and 9 digits, for all values at once, and the
    first decimal that converts back to the value is taken. The result is the double nearest to that
    decimal, whose own shortest text is the decimal: any printer of doubles then prints it.

    Zeros keep their sign; values that are not finite are unchanged.
    """
    exact = values.astype(np.float64)
    size = np.abs(exact)
    # Where nine digits are a whole number below 2^53 after scaling by an exact power of ten.
    usual = (size > 1e-13) & (size < 1e5)
    scale = _POWERS[_MIN_DIGITS - 1 - _exponents(np.where(usual, size, 1.0))]
    result = exact.copy()
    todo = usual
    for _ in range(_MIN_DIGITS, _MAX_DIGITS + 1):
        rounded = np.rint(exact * scale) / scale
        found = todo & (rounded.astype(np.float32) == values)
        np.copyto(result, rounded, where=found)
        todo = todo & ~found
        scale *= 10.0
    rare = (todo | ~usual) & np.isfinite(exact) & (exact != 0.0)
    if rare.any():
        result[rare] = _shortest_of_rare(values[rare])
    return result


def _shortest_of_rare(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the doubles (n,) of values (n,) of any size, as `shortest_doubles` does.

    Rotations that should be zero are often about 1e-20, so these are computed together, too. A
    quotient by an inexact power of ten is corrected by its remainder (Dekker 1971).
    """
    exact = values.astype(np.float64)
    size = np.abs(exact)
    # Normal singles whose powers of ten are in the table. Of powers of two, the nearest decimal is
    # not always the shortest, because their neighbours are not equally far away.
    tiny = (size > 1e-37) & (size <= 1e-13) & (np.frexp(size)[0] != 0.5)
    power = _MIN_DIGITS - 1 - _exponents(np.where(tiny, size, 1.0))
    digits, chosen = np.zeros_like(exact), np.zeros_like(power)
    todo = tiny
    for _ in range(_MIN_DIGITS, _MAX_DIGITS + 1):
        scale = _HIGH[power]
        whole = np.rint(exact * scale)
        found = todo & ((whole / scale).astype(np.float32) == values)
        np.copyto(digits, whole, where=found)
        np.copyto(chosen, power, where=found)
        todo = todo & ~found
        power += 1
    result = _quotients(digits, _HIGH[chosen], _LOW[chosen])
    others = todo | ~tiny
    if others.any():
        result[others] = [float(str(value)) for value in values[others]]
    return result


def _exponents(size: NDArray[np.float64]) -> NDArray[np.intp]:
    exponents: NDArray[np.intp] = np.floor(np.log10(size)).astype(np.intp)
    return exponents


def _quotients(
    whole: NDArray[np.float64], high: NDArray[np.float64], low: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the doubles nearest to whole / (high + low), where `low` is below an ulp of `high`."""
    near = whole / high
    near_top, near_rest = _halves(near)
    high_top, high_rest = _halves(high)
    product = near * high
    rounding = near_rest * high_rest - (
        ((product - near_top * high_top) - near_rest * high_top) - near_top * high_rest
    )
    remainder = ((whole - product) - rounding) - near * low
    nearest: NDArray[np.float64] = near + remainder / high
    return nearest


def _halves(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Split doubles into two of at most 26 bits each (Veltkamp), so that products are exact."""
    scaled = values * _SPLITTER
    top = scaled - (scaled - values)
    return top, values - top


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
    own = iter(shortest_doubles(side.values).tolist())
    return [next(own) if present else missing for present in side.present.tolist()]
