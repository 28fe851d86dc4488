"""Compute the joint errors of a phase over its active time: a summary, and their course over time.

Both are stored for two references: the pose that was commanded at that moment (`present`, which
shows the effect of the latency) and the delayed command (`command`, which shows the quality of the
controller). For a physics avatar, the reference is the participant's pose as its hinges can
reproduce it, before their limits are applied; how often the limits clipped it is stored as well.
Both can be recomputed at any time.

The summary has rows for the finger parts, too, if fingers were recorded. The course over time is
that of the body in all sessions, so that it means the same with and without fingers.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry.movement import Run
from app.models import JointErrorCourseRow, JointErrorRow, Phase
from app.science.joint_error import (
    ERROR_JOINTS,
    JointErrorSummary,
    Recorded,
    active_times,
    joint_error_course,
    recorded_errors,
)
from app.science.rotations import FloatArray

Indices = NDArray[np.int64]
BODY = len(ERROR_JOINTS)


def joint_error_rows(
    phase: Phase, runs: Sequence[Run]
) -> list[JointErrorRow | JointErrorCourseRow]:
    """Return the rows of a phase for both tables; none if it has no frames."""
    if not runs:
        return []
    pairs = [_counted(run) for run in runs]
    recorded = [_recorded(run, *own) for run, own in zip(runs, pairs, strict=True)]
    errors = recorded_errors(recorded, phase.latency_ms / 1000.0)
    active_s = _active_times(runs, [frames for _, frames in pairs])
    return [
        *_rows(phase, "present", errors.present),
        *_rows(phase, "command", errors.command),
        _course(phase, "present", errors.present_rad[:, :BODY], active_s),
        _course(phase, "command", errors.command_rad[:, :BODY], active_s),
    ]


def _counted(run: Run) -> tuple[Indices, Indices]:
    """Pair the avatar's active frames with target frames of the same seq.

    Returns the indices (target, actual).
    """
    _, at_target, at_actual = np.intersect1d(
        run.target.seq, run.actual.seq, assume_unique=True, return_indices=True
    )
    counted = run.actual.active[at_actual]
    return at_target[counted], at_actual[counted]


def _recorded(run: Run, partners: Indices, frames: Indices) -> Recorded:
    return Recorded(
        run.target.times_s,
        run.reference,
        partners,
        run.actual.times_s[frames],
        run.actual_rotations[frames],
    )


def _active_times(runs: Sequence[Run], frames: Sequence[Indices]) -> FloatArray:
    """Return the phase's active time, s, at these frames of each epoch, continued across epochs."""
    spent_s, found = 0.0, []
    for run, own in zip(runs, frames, strict=True):
        passed_s = spent_s + active_times(run.actual.times_s, run.actual.active)
        found.append(passed_s[own])
        spent_s = float(passed_s[-1])
    return np.concatenate(found)


def _course(
    phase: Phase, reference: str, angles_rad: FloatArray, active_s: FloatArray
) -> JointErrorCourseRow:
    course = joint_error_course(angles_rad, active_s, phase.active_s)
    return JointErrorCourseRow(
        session_id=phase.session_id,
        phase_id=phase.phase_id,
        reference=reference,
        bin_s=course.bin_s,
        mean_rad=[None if np.isnan(one) else float(one) for one in course.mean_rad],
        samples=course.samples.tolist(),
    )


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
