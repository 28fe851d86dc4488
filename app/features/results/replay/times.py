"""Compute a phase's clock from the record."""

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from typing import NamedTuple

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.results.replay.clock import (
    ClockReport,
    PhaseClock,
    Run,
    Wall,
    later_by,
    stretches,
)
from app.models import ClientReport, Contact, Phase, StudySession, TelemetryBatch, TelemetryChunk
from app.wire import MalformedBatchError, decode_batch

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_US = timedelta(microseconds=1)


class _Span(NamedTuple):
    """The first and last moment at which a run recorded the phase, on the run's own clock."""

    first_s: float
    last_s: float


def phase_clock(db: Session, session: StudySession, phase: Phase) -> PhaseClock:
    """Return the clock of a phase; without any record, its duration is 0."""
    reports, heard = _clock_reports(db, phase)
    spans = _spans(db, phase, reports)
    if not spans:
        return PhaseClock({}, (), (), session.time_scale)
    first = next((one.epoch for one in reports if one.what == "started"), min(spans))
    zero_s = _zero(phase, reports, spans[first])
    # Exclude what was recorded while the phase was being prepared.
    spans[first] = _Span(zero_s, max(spans[first].last_s, zero_s))
    walls = _walls(db, session, phase, spans, heard)
    offsets_s: dict[int, float] = {}
    runs: list[Run] = []
    for epoch in [first, *sorted(set(spans) - {first})]:
        begin_s = _begin(runs, walls[first], walls[epoch], session.time_scale)
        offsets_s[epoch] = begin_s - spans[epoch].first_s
        end_s = begin_s + spans[epoch].last_s - spans[epoch].first_s
        runs.append(Run(epoch, begin_s, end_s, *walls[epoch]))
    # Without any report, the clock is assumed to have run all the time.
    assumed = reports or [ClockReport(first, "started", zero_s, 0.0, "")]
    active = stretches(assumed, offsets_s, phase.active_s)
    return PhaseClock(offsets_s, tuple(runs), active, session.time_scale)


def clock_reports_of(db: Session, phase: Phase) -> list[ClockReport]:
    """Return the headset's reports on the phase's clock in order, including rejected ones."""
    return _clock_reports(db, phase)[0]


def _begin(runs: Sequence[Run], first: Wall, own: Wall, time_scale: float) -> float:
    """Return when a run begins: by the wall clock, else at the end of the previous run."""
    if not runs:
        return 0.0
    if first.utc is None or own.utc is None:
        return max(run.end_s for run in runs)
    return (own.utc - first.utc).total_seconds() * time_scale


def _zero(phase: Phase, reports: Sequence[ClockReport], span: _Span) -> float:
    """Return when the phase's clock first ran, on the clock of that run."""
    started_s = next(
        (one.client_s for one in reports if one.what == "started"), phase.client_started_s
    )
    return span.first_s if started_s is None else started_s


def _clock_reports(
    db: Session, phase: Phase
) -> tuple[list[ClockReport], dict[int, tuple[float, datetime]]]:
    """Return the headset's reports, and when the server received the first of each run.

    The second is, by epoch, (client's time, UTC).
    """
    rows = db.execute(
        select(ClientReport.epoch, ClientReport.payload, ClientReport.received_at)
        .where(ClientReport.session_id == phase.session_id, ClientReport.type == "phase")
        .order_by(ClientReport.epoch, ClientReport.seq)
    )
    reports: list[ClockReport] = []
    heard: dict[int, tuple[float, datetime]] = {}
    for epoch, payload, received_at in rows:
        if payload["phase_id"] == phase.phase_id:
            one = (payload["what"], payload["t_s"], payload["active_s"], payload["cause"])
            reports.append(ClockReport(epoch, *one))
            heard.setdefault(epoch, (payload["t_s"], received_at))
    return reports, heard


def _spans(db: Session, phase: Phase, reports: Sequence[ClockReport]) -> dict[int, _Span]:
    """Return the spans by epoch, from movement, reports and contacts, whichever reach further."""
    found: dict[int, list[float]] = {}
    chunks = select(
        TelemetryChunk.epoch,
        func.min(TelemetryChunk.t_first_s),
        func.max(TelemetryChunk.t_last_s),
    ).where(
        TelemetryChunk.session_id == phase.session_id, TelemetryChunk.phase_id == phase.phase_id
    )
    for epoch, *ends_s in db.execute(chunks.group_by(TelemetryChunk.epoch)):
        found.setdefault(epoch, []).extend(ends_s)
    batches = select(TelemetryBatch).where(
        TelemetryBatch.session_id == phase.session_id, TelemetryBatch.phase_id == phase.phase_id
    )
    for row in db.scalars(batches):
        found.setdefault(row.epoch, []).extend(_batch_times(row))
    for one in reports:
        found.setdefault(one.epoch, []).append(one.client_s)
    spans = {}
    for epoch, times_s in found.items():
        usable = [float(one) for one in times_s if one is not None and np.isfinite(one)]
        if usable:
            spans[epoch] = _Span(min(usable), max(usable))
    if not spans and phase.client_started_s is not None:
        ended_s = phase.client_ended_s or phase.client_started_s + phase.active_s
        return {_only_epoch(db, phase): _Span(phase.client_started_s, ended_s)}
    return spans


def _batch_times(row: TelemetryBatch) -> list[float]:
    try:
        return [float(one) for one in decode_batch(row.message).times_s]
    except MalformedBatchError:
        return []


def _only_epoch(db: Session, phase: Phase) -> int:
    """Return the first epoch with contacts of a phase without movement; 1 if there are none."""
    query = select(func.min(Contact.epoch)).where(
        Contact.session_id == phase.session_id, Contact.phase_id == phase.phase_id
    )
    return db.scalar(query) or 1


def _walls(
    db: Session,
    session: StudySession,
    phase: Phase,
    spans: dict[int, _Span],
    heard: dict[int, tuple[float, datetime]],
) -> dict[int, Wall]:
    """Return, by epoch, the server's time at which its span began."""
    # Imported here because it loads pandas, which would slow down the server's start.
    from app.features.results.analysis.tables import run_clocks

    clocks = run_clocks(db, session.id)
    walls = {}
    for epoch, span in spans.items():
        wall = Wall(phase.started_at if len(spans) == 1 else None)
        latest = None
        if epoch in heard:
            client_s, received_at = heard[epoch]
            latest = later_by(received_at, span.first_s - client_s, session.time_scale)
        if epoch in clocks:
            utc, uncertainty_ms = clocks[epoch].to_utc(np.array([span.first_s]))
            if not np.isnat(utc[0]):
                wall = Wall(_EPOCH + int(utc[0].astype(np.int64)) * _US, float(uncertainty_ms[0]))
                wall = wall if latest is None else wall.no_later_than(latest)
        elif latest is not None:
            wall = Wall(latest)
        walls[epoch] = wall
    return walls
