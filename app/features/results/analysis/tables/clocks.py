"""Map the clocks of a session's client runs to UTC, from the recorded clock probes.

A run's clock is mapped to the server's monotonic clock (`app.science.clock`). UTC is fixed to that
clock once per session, by the first probes: if the server's wall clock is set in mid-session, no
duration changes, and only `server_utc_step_ms` shows it. UTC is fixed again only if the server's
machine was restarted between two runs, because its monotonic clock then began again.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from itertools import groupby
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import ClockProbe, StudySession
from app.science.clock import ClockMapping, ClockProbes, fit_clock

NS_PER_S = 1_000_000_000
_EPOCH_UTC = datetime(1970, 1, 1, tzinfo=UTC)


class Reading(NamedTuple):
    """A clock probe as stored; the times are None if it was not answered."""

    epoch: int
    client_sent_s: float
    server_received_ns: int | None
    server_sent_ns: int | None
    client_received_s: float | None
    server_utc: datetime


@dataclass(frozen=True)
class RunClock:
    """The clock of one client run, mapped to the server's clock and to UTC.

    Attributes:
        mapping: From the client's time divided by `time_scale` to the server's monotonic time less
          `base_s`, both in s.
        anchor_s: UTC at the server's time `base_s`, in s since 1970 and since `base_utc`.
    """

    epoch: int
    mapping: ClockMapping
    base_s: float
    base_utc: datetime
    anchor_s: float
    time_scale: float

    def to_utc(
        self, client_s: npt.NDArray[np.float64]
    ) -> tuple[npt.NDArray[np.datetime64], npt.NDArray[np.float64]]:
        """Return UTC, to the microsecond, and its uncertainty in ms for client times (k,).

        The uncertainty is that of the two monotonic clocks; UTC itself is that of the server's wall
        clock. NaT and NaN where there is no probe.
        """
        server_s, uncertainty_s = self.mapping.to_server(client_s / self.time_scale)
        mapped = np.isfinite(uncertainty_s)
        utc = np.full(len(client_s), np.datetime64("NaT"), dtype="datetime64[us]")
        zero = (self.base_utc - _EPOCH_UTC) // timedelta(microseconds=1)
        since = np.round((server_s[mapped] + self.anchor_s) * 1e6).astype(np.int64)
        utc[mapped] = (zero + since).astype("datetime64[us]")
        return utc, np.where(mapped, 1000.0 * uncertainty_s, np.nan)


def run_clocks(db: Session, session_id: str) -> dict[int, RunClock]:
    """Return the clocks of a session's client runs by epoch; runs without a probe are left out."""
    query = (
        select(
            ClockProbe.epoch,
            ClockProbe.client_sent_s,
            ClockProbe.server_received_ns,
            ClockProbe.server_sent_ns,
            ClockProbe.client_received_s,
            ClockProbe.server_utc,
        )
        .where(ClockProbe.session_id == session_id)
        .order_by(ClockProbe.epoch, ClockProbe.client_sent_s, ClockProbe.id)
    )
    readings = [Reading(*row) for row in db.execute(query)]
    answered = [reading for reading in readings if reading.server_received_ns is not None]
    if not answered:
        return {}
    scale = db.scalars(select(StudySession.time_scale).where(StudySession.id == session_id)).one()
    return {clock.epoch: clock for clock in _fitted(answered, scale)}


def add_utc(db: Session, frame: pd.DataFrame, seconds: str, name: str) -> None:
    """Add the UTC times of the column `seconds` to a table with `session_id` and `epoch`.

    `name` is the new column; the column `clock_uncertainty_ms` is added, too.
    """
    frame[name] = pd.Series(pd.NaT, index=frame.index, dtype="datetime64[us]")
    frame["clock_uncertainty_ms"] = np.nan
    for session_id, of_session in frame.groupby("session_id"):
        clocks = run_clocks(db, str(session_id))
        for epoch, rows in of_session.groupby("epoch"):
            clock = clocks.get(int(str(epoch)))
            if clock is not None:
                utc, uncertainty_ms = clock.to_utc(rows[seconds].to_numpy(dtype=np.float64))
                frame.loc[rows.index, name] = utc
                frame.loc[rows.index, "clock_uncertainty_ms"] = uncertainty_ms


def _fitted(answered: Sequence[Reading], scale: float) -> Iterator[RunClock]:
    base_ns, base_utc = answered[0].server_received_ns or 0, answered[0].server_utc
    previous: RunClock | None = None
    last: Reading | None = None
    for epoch, group in groupby(answered, key=lambda reading: reading.epoch):
        own = _in_order(list(group))
        mapping = fit_clock(_probes(own, base_ns, base_utc, scale))
        if not mapping.segments:
            continue
        if previous is None or last is None or _restarted(last, own[0]):
            anchor_s = mapping.wall_s
        else:
            # The shift that undid jumps of the server's clock in that run also applies to this one.
            anchor_s = previous.anchor_s + previous.mapping.segments[-1].server_shift_s
        previous = RunClock(epoch, mapping, base_ns / NS_PER_S, base_utc, anchor_s, scale)
        last = own[-1]
        yield previous


def _in_order(readings: list[Reading]) -> list[Reading]:
    """Return the readings in the order in which they were made.

    They are read in the order of the client's time, which is wrong if the client's clock was set
    back. Then the order of the server's wall clock is used, which could be wrong if that was set
    back.
    """
    server = [reading.server_received_ns or 0 for reading in readings]
    if server == sorted(server):
        return readings
    return sorted(readings, key=lambda reading: (reading.server_utc, reading.client_sent_s))


def _restarted(last: Reading, first: Reading) -> bool:
    """Return whether the server's machine was restarted between two readings.

    If it was, its monotonic clock is behind, or so little ahead that it began after the first
    reading.
    """
    then_ns, now_ns = last.server_received_ns or 0, first.server_received_ns or 0
    began = first.server_utc - timedelta(microseconds=now_ns / 1000)
    return now_ns < then_ns or began > last.server_utc


def _probes(
    readings: Sequence[Reading], base_ns: int, base_utc: datetime, scale: float
) -> ClockProbes:
    """Return the readings in s since their common base, the client's in real seconds."""

    def server(ns: int | None) -> float:
        return np.nan if ns is None else (ns - base_ns) / NS_PER_S

    def client(seconds: float | None) -> float:
        return np.nan if seconds is None else seconds / scale

    return ClockProbes(
        np.array([client(reading.client_sent_s) for reading in readings]),
        np.array([server(reading.server_received_ns) for reading in readings]),
        np.array([server(reading.server_sent_ns) for reading in readings]),
        np.array([client(reading.client_received_s) for reading in readings]),
        np.array([(reading.server_utc - base_utc).total_seconds() for reading in readings]),
    )
