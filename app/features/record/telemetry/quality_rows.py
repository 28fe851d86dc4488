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
from app.wire import MAX_TIME_S, StreamName, flag_frames

HISTORY_S = 10.0
"""How much target movement before the phase is read: a joint may have frozen before it."""


def phase_quality(db: Session, session_id: str, phase_id: int) -> list[PhaseQuality]:
    """Compute the quality rows of a phase without storing them.

    Raises NoResultFound if there is no such phase, and ValueError if a stored chunk is damaged.
    """
    phase = db.get_one(Phase, (session_id, phase_id))
    return quality_rows(phase, phase_runs(db, session_id, phase_id, history_s=HISTORY_S))


def quality_rows(phase: Phase, runs: Sequence[Run]) -> list[PhaseQuality]:
    """Return the rows of both streams from frames already read, even if there are no frames.

    Streams of fingers have rows of their own where they were recorded.
    """
    target = combine([_quality(run.target, _in_phase(run, run.target)) for run in runs])
    actual = combine([_quality(run.actual, run.actual.active) for run in runs])
    rows = [_row(phase, StreamName.TARGET, target), _row(phase, StreamName.ACTUAL, actual)]
    # A run without fingers, beside others that have them, has no frames of them.
    fingers = [(run, *run.fingers) for run in runs if run.fingers and len(run.fingers[1])]
    if fingers:
        target = combine([_of_fingers(one, _in_phase(run, one)) for run, one, _ in fingers])
        actual = combine([_of_fingers(one, one.active) for _, _, one in fingers])
        rows.append(_row(phase, StreamName.TARGET_FINGERS, target))
        rows.append(_row(phase, StreamName.ACTUAL_FINGERS, actual))
    return rows


def _in_phase(run: Run, target: Frames) -> NDArray[np.bool_]:
    """Select the target's active frames whose seqs are in the range of the actual body's seqs."""
    seq = run.actual.seq
    of_phase = (target.seq >= seq[0]) & (target.seq <= seq[-1])
    return np.asarray(target.active & of_phase)


def _of_fingers(frames: Frames, counted: NDArray[np.bool_]) -> StreamQuality:
    """Assess the timing of fingers, and count their frames with broken values.

    Trackers lose and find hands all the time, so a finger that jumps or rests is no fault.
    """
    standing = np.zeros((len(frames), JOINT_COUNT, 4), np.float32)
    standing[..., 0] = 1.0
    quality = assess(frames.times_s, standing, np.zeros((len(frames), 3)), counted=counted)
    flags = flag_frames(frames.times_s, frames.values)
    return replace(
        quality,
        non_unit=int((flags.non_unit & counted).sum()),
        non_finite=int((flags.non_finite & counted).sum()),
    )


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
