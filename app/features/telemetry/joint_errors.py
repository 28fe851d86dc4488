"""Joint error of a phase from its stored frames, over active time only.

Stored twice: against what the avatar was asked for at that moment (`present`, what the latency
costs) and against the delayed command (`command`, how good the controller is). What a physics
avatar is asked for is what its hinges can make of the participant's pose, before their limits; how
often these took something away is stored with it. Both can be computed again at any time.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from app.features.telemetry.encoding import Frames
from app.features.telemetry.movement import Run
from app.models import JointErrorRow, Phase
from app.science.joint_error import JointErrorSummary
from app.science.recorded_error import Recorded, recorded_errors


def joint_error_rows(phase: Phase, runs: Sequence[Run]) -> list[JointErrorRow]:
    """The rows of a phase; none where it has no frames."""
    if not runs:
        return []
    errors = recorded_errors([_recorded(run) for run in runs], phase.latency_ms / 1000.0)
    return [*_rows(phase, "present", errors.present), *_rows(phase, "command", errors.command)]


def _recorded(run: Run) -> Recorded:
    """The active frames of the avatar that have a partner."""
    at_target, at_actual = _paired(run.target, run.actual)
    counted = run.actual.active[at_actual]
    frames = at_actual[counted]
    return Recorded(
        run.target.times_s,
        run.asked,
        at_target[counted],
        run.actual.times_s[frames],
        run.actual.rotations[frames],
    )


def _paired(target: Frames, actual: Frames) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices of the frames of both streams that carry the same seq."""
    _, at_target, at_actual = np.intersect1d(
        target.seq, actual.seq, assume_unique=True, return_indices=True
    )
    return at_target, at_actual


def _rows(phase: Phase, reference: str, summary: JointErrorSummary) -> Iterator[JointErrorRow]:
    for joint_index, joint in enumerate(summary.joints):
        for axis_index, axis in enumerate(summary.axes):
            yield JointErrorRow(
                session_id=phase.session_id,
                phase_id=phase.phase_id,
                reference=reference,
                joint=joint,
                axis=axis,
                **_figures(summary, (joint_index, axis_index)),
                samples=int(summary.count[joint_index]),
                excluded=int(summary.left_out[joint_index]),
            )


def _figures(summary: JointErrorSummary, at: tuple[int, int]) -> dict[str, float | None]:
    return {
        name: None if np.isnan(values[at]) else float(values[at])
        for name, values in (
            ("mean_rad", summary.mean_rad),
            ("rms_rad", summary.rms_rad),
            ("p95_rad", summary.p95_rad),
            ("max_rad", summary.max_rad),
            ("clipped_share", summary.clipped_share),
        )
    }
