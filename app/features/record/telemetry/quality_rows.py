"""Compute the data quality of a phase over its active time, one row per stream.

This repeats the checks that raise alarms while the phase runs, but on the stored data. Faults in
pauses and on walks back do not count, because those frames are not analysed.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import Frames
from app.features.record.telemetry.movement import Run, phase_runs
from app.models import Phase, PhaseQuality
from app.science.skeleton import JOINT_COUNT
from app.science.stream_quality import StreamQuality, assess, combine
from app.wire import MAX_TIME_S, StreamName

HISTORY_S = 10.0
"""How much target movement before the phase is read: a joint may have frozen before it."""


def phase_quality(db: Session, session_id: str, phase_id: int) -> list[PhaseQuality]:
    """Compute the quality rows of a phase without storing them.

    Raises NoResultFound if there is no such phase, and ValueError if a stored chunk is damaged.
    """
    phase = db.get_one(Phase, (session_id, phase_id))
    return quality_rows(phase, phase_runs(db, session_id, phase_id, history_s=HISTORY_S))


def quality_rows(phase: Phase, runs: Sequence[Run]) -> list[PhaseQuality]:
    """Return the rows of both streams from frames already read, even if there are no frames."""
    target = combine([_quality(run.target, _in_phase(run)) for run in runs])
    actual = combine([_quality(run.actual, run.actual.active) for run in runs])
    return [_row(phase, StreamName.TARGET, target), _row(phase, StreamName.ACTUAL, actual)]


def _in_phase(run: Run) -> NDArray[np.bool_]:
    """Select the active target frames whose seqs are in the range of the actual body's."""
    seq = run.actual.seq
    of_phase = (run.target.seq >= seq[0]) & (run.target.seq <= seq[-1])
    return np.asarray(run.target.active & of_phase)


def _quality(frames: Frames, counted: NDArray[np.bool_]) -> StreamQuality:
    values = frames.values
    rotations = values[:, 3:].reshape(len(frames), JOINT_COUNT, 4)
    quality = assess(frames.times_s, rotations, values[:, :3], counted=counted)
    untimed = ~(np.abs(frames.times_s) <= MAX_TIME_S) & counted
    return replace(quality, backwards=quality.backwards + int(untimed.sum()))


def _row(phase: Phase, stream: StreamName, quality: StreamQuality) -> PhaseQuality:
    return PhaseQuality(
        session_id=phase.session_id,
        phase_id=phase.phase_id,
        stream=str(stream),
        frames=quality.frames,
        span_s=quality.span_s,
        frame_rate_hz=quality.frame_rate_hz,
        gaps=quality.gaps,
        gap_s=quality.gap_s,
        longest_gap_s=quality.longest_gap_s,
        jumps=quality.jumps,
        frozen_s=max(quality.frozen_s),
        frozen_joints=list(quality.frozen_joints),
        non_unit=quality.non_unit,
        non_finite=quality.non_finite,
        backwards=quality.backwards,
    )
