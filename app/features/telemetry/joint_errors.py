"""Joint error of a phase from its stored frames, over active time only.

Stored twice: against the participant's pose at that moment (`present`, what the latency costs) and
against the delayed command (`command`, how good the controller is). Both can be computed again at
any time.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from app.features.telemetry.encoding import Frames
from app.features.telemetry.movement import Run
from app.models import JointErrorRow, Phase
from app.science.avatar.delay import delayed_pose
from app.science.joint_error import JointErrorSummary, joint_error_summary

Rotations = NDArray[np.float64]


def joint_error_rows(phase: Phase, runs: Sequence[Run]) -> list[JointErrorRow]:
    """The rows of a phase; none where it has no frames."""
    delay_s = phase.latency_ms / 1000.0
    present: list[tuple[Rotations, Rotations]] = []
    command: list[tuple[Rotations, Rotations]] = []
    for run in runs:
        at_target, at_actual = _paired(run.target, run.actual)
        counted = run.actual.active[at_actual]
        got = run.actual.rotations[at_actual][counted]
        present.append((run.target.rotations[at_target][counted], got))
        command.append((_commanded(run, at_actual, delay_s)[counted], got))
    return [*_rows(phase, "present", present), *_rows(phase, "command", command)]


def _paired(target: Frames, actual: Frames) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices of the frames of both streams that carry the same seq."""
    _, at_target, at_actual = np.intersect1d(
        target.seq, actual.seq, assume_unique=True, return_indices=True
    )
    return at_target, at_actual


def _commanded(run: Run, at_actual: NDArray[np.int64], delay_s: float) -> Rotations:
    """The delayed command at the time of each paired actual frame; NaN where it is unknown."""
    query_s = run.actual.times_s[at_actual]
    commanded = np.full((len(query_s), 22, 4), np.nan)
    times_s, rotations = run.target.times_s, run.target.rotations
    rising = _rising(times_s)
    known = np.isfinite(query_s)
    if rising.any() and known.any():
        commanded[known] = delayed_pose(times_s[rising], rotations[rising], query_s[known], delay_s)
    return commanded


def _rising(times_s: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The samples whose time is finite and later than all before."""
    usable = np.where(np.isfinite(times_s), times_s, -np.inf)
    before = np.concatenate(([-np.inf], np.maximum.accumulate(usable)[:-1]))
    return np.asarray(usable > before)


def _rows(
    phase: Phase, reference: str, pairs: list[tuple[Rotations, Rotations]]
) -> Iterator[JointErrorRow]:
    if not pairs:
        return
    summary = joint_error_summary(
        np.concatenate([wanted for wanted, _ in pairs]), np.concatenate([got for _, got in pairs])
    )
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
        f"{name}_rad": None if np.isnan(values[at]) else float(values[at])
        for name, values in (
            ("mean", summary.mean_rad),
            ("rms", summary.rms_rad),
            ("p95", summary.p95_rad),
            ("max", summary.max_rad),
        )
    }
