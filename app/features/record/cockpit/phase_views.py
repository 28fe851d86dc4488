"""Summarise each phase of a session for the cockpit."""

from collections.abc import Sequence
from typing import TypedDict

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.record.cockpit.schemas import PhaseView
from app.models import Completion, Contact, Phase, PhaseLatency, StudySession
from app.science.tasks import side_unit, union

_MS_DIGITS = 3
_LATE_S = 1.0
"""What a headset records for so long after the last of its frames on disk is no contradiction."""


class _Latency(TypedDict):
    """The fields of `PhaseView` that describe the achieved latency."""

    achieved_latency_ms: float | None
    achieved_low_ms: float | None
    achieved_high_ms: float | None
    latency_off: bool | None
    latency_reason: str | None
    movement_s: float | None


class _Counts(TypedDict):
    """The fields of `PhaseView` that count what happened in the phase."""

    completions: int | None
    side_contacts: int | None
    side_contact_s: float | None


def phase_views(db: Session, session: StudySession, *, blinded: bool) -> list[PhaseView]:
    """Return all phases of a session in order; latencies are omitted for a blinded operator.

    While a phase runs, its completions and contacts are, too: the moment at which a count rises,
    beside the participant's pose, is late by the latency.
    """
    completions = dict(
        db.execute(
            select(Completion.phase_id, func.count())
            .where(Completion.session_id == session.id)
            .group_by(Completion.phase_id)
        ).all()
    )
    sides, until = _side_contacts(db, session), _recorded_until_s(db, session)
    latencies = {
        row.phase_id: row
        for row in db.scalars(select(PhaseLatency).where(PhaseLatency.session_id == session.id))
    }
    phases = db.scalars(
        select(Phase).where(Phase.session_id == session.id).order_by(Phase.phase_id)
    )
    return [
        PhaseView(
            phase_id=phase.phase_id,
            step_index=phase.step_index,
            attempt=phase.attempt,
            kind=phase.kind,
            limb=phase.limb,
            latency_ms=None if blinded else phase.latency_ms,
            body=None if blinded else phase.body,
            status=phase.status,
            active_s=_active_s(phase, until.get(phase.phase_id, 0.0)),
            **_counts(
                completions.get(phase.phase_id, 0),
                sides.get(phase.phase_id, (0, 0.0)),
                hidden=blinded and phase.ended_at is None,
            ),
            **_latency(latencies.get(phase.phase_id), blinded=blinded),
            started_at=phase.started_at,
            ended_at=phase.ended_at,
        )
        for phase in phases
    ]


def _active_s(phase: Phase, until_s: float) -> float | None:
    """Return a phase's active time; None where a voided one went on for longer than is known.

    Records made before an interruption was stored with its time say nothing, or when it last
    paused. `until_s`: the active time until which something was recorded in the phase.
    """
    is_unknown = phase.active_s == 0.0 or until_s > phase.active_s + _LATE_S
    is_voided = phase.status == "voided" and phase.started_at is not None
    return None if is_voided and is_unknown else phase.active_s


def _recorded_until_s(db: Session, session: StudySession) -> dict[int, float]:
    """Return, for each phase, the active time of its last completion or end of a contact."""
    until: dict[int, float] = {}
    for row, time_s in (
        (Contact, Contact.end_active_s),
        (Completion, Completion.active_s),
    ):
        query = (
            select(row.phase_id, func.max(time_s))
            .where(row.session_id == session.id)
            .group_by(row.phase_id)
        )
        for phase_id, last_s in db.execute(query):
            until[phase_id] = max(until.get(phase_id, 0.0), last_s)
    return until


def _counts(completions: int, sides: tuple[int, float], *, hidden: bool) -> _Counts:
    if hidden:
        return _Counts(completions=None, side_contacts=None, side_contact_s=None)
    return _Counts(completions=completions, side_contacts=sides[0], side_contact_s=sides[1])


def _latency(row: PhaseLatency | None, *, blinded: bool) -> _Latency:
    """Return a phase's measured latency, without numbers or reasons for a blinded operator."""
    shown = None if blinded else row
    return _Latency(
        achieved_latency_ms=_ms(shown.achieved_s if shown else None),
        achieved_low_ms=_ms(shown.low_s if shown else None),
        achieved_high_ms=_ms(shown.high_s if shown else None),
        latency_off=row.flagged if row and row.achieved_s is not None else None,
        latency_reason=shown.reason if shown else None,
        movement_s=row.movement_s if row else None,
    )


def _ms(time_s: float | None) -> float | None:
    return None if time_s is None else round(1000.0 * time_s, _MS_DIGITS)


def _side_contacts(db: Session, session: StudySession) -> dict[int, tuple[int, float]]:
    """Return, for each phase, how many times a side turned red and for how long in total.

    A side is red while at least one body part touches it, so the intervals of the parts are merged
    first.
    """
    spans: dict[int, dict[str, list[tuple[float, float]]]] = {}
    for phase_id, surface, begin_s, end_s in db.execute(
        select(
            Contact.phase_id, Contact.surface, Contact.begin_active_s, Contact.end_active_s
        ).where(Contact.session_id == session.id, Contact.surface_kind == "side")
    ):
        unit = side_unit(surface) or surface
        spans.setdefault(phase_id, {}).setdefault(unit, []).append((begin_s, end_s))
    return {
        phase_id: _count_and_length([red for own in by_side.values() for red in union(own)])
        for phase_id, by_side in spans.items()
    }


def _count_and_length(spans: Sequence[tuple[float, float]]) -> tuple[int, float]:
    return len(spans), sum(end_s - begin_s for begin_s, end_s in spans)
