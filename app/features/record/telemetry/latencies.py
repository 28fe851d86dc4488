"""Measure the latency that a phase actually had, from its stored frames."""

from collections.abc import Sequence

from sqlalchemy.orm import Session

from app.features.record.telemetry.movement import Run, phase_runs
from app.models import Phase, PhaseLatency
from app.science.latency import HIGHEST_S, AchievedLatency, StreamPair, is_off, latency_of_runs
from app.science.skeleton import JOINT_COUNT

MS_PER_S = 1000.0
# How far beyond the set latency the search extends if that latency is long.
_BEYOND_S = 0.5


def phase_latency(db: Session, session_id: str, phase_id: int) -> AchievedLatency:
    """Measure a phase's latency without storing it (see `app.science.latency`).

    Raises NoResultFound if there is no such phase.
    """
    phase = db.get_one(Phase, (session_id, phase_id))
    return measure(phase, phase_runs(db, session_id, phase_id, history_s=history_s(phase)))


def history_s(phase: Phase) -> float:
    """Return how much target movement before a phase is needed: the longest lag, and a second."""
    return longest_lag_s(phase) + 1.0


def longest_lag_s(phase: Phase) -> float:
    """Return the longest latency to search for, well beyond the latency that is set."""
    return max(HIGHEST_S, phase.latency_ms / MS_PER_S + _BEYOND_S)


def measure(phase: Phase, runs: Sequence[Run]) -> AchievedLatency:
    """Measure the achieved latency of a phase from frames that were already read."""
    pairs = [
        StreamPair(
            run.target.times_s,
            run.reference.rotations[:, :JOINT_COUNT],
            run.actual.times_s,
            run.actual.rotations,
            run.actual.active,
        )
        for run in runs
    ]
    return latency_of_runs(pairs, highest_s=longest_lag_s(phase))


def latency_rows(phase: Phase, runs: Sequence[Run]) -> list[PhaseLatency]:
    """Return the latency row of a phase, which exists even if no latency could be measured."""
    achieved = measure(phase, runs)
    ordered_s = phase.latency_ms / MS_PER_S
    return [
        PhaseLatency(
            session_id=phase.session_id,
            phase_id=phase.phase_id,
            ordered_s=ordered_s,
            achieved_s=achieved.latency_s,
            low_s=achieved.low_s,
            high_s=achieved.high_s,
            movement_s=achieved.movement_s,
            frame_s=achieved.frame_s,
            samples=achieved.samples,
            flagged=is_off(achieved, ordered_s),
            reason=achieved.reason,
        )
    ]
