"""Joint error of a phase, computed once its frames are on disk, over active time only.

Stored twice: against the participant's pose at that moment (`present`, what the latency costs) and
against the delayed command (`command`, how good the controller is). Both can be computed again at
any time from the stored frames.
"""

import logging
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from app.features.context import AppContext
from app.features.telemetry.encoding import Frames
from app.features.telemetry.frames import concatenate, iter_frames, phase_frames
from app.models import JointErrorRow, Phase
from app.science.avatar.delay import delayed_pose
from app.science.joint_error import JointErrorSummary, joint_error_summary
from app.wire import StreamName

log = logging.getLogger(__name__)
Rotations = NDArray[np.float64]


@dataclass
class Summariser:
    """Computes summaries in the background, one phase at a time."""

    context: AppContext
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="summaries")
    )

    def phase_ended(self, session_id: str, phase_id: int) -> None:
        """Queue a phase whose last frame is on disk."""
        self._pool.submit(self._run, session_id, phase_id)

    def catch_up(self) -> None:
        """Queue every phase that ended without a summary, as after a crash."""
        with self.context.database.reading() as db:
            missing = db.execute(
                select(Phase.session_id, Phase.phase_id).where(
                    Phase.status == "done",
                    ~select(JointErrorRow.joint)
                    .where(
                        JointErrorRow.session_id == Phase.session_id,
                        JointErrorRow.phase_id == Phase.phase_id,
                    )
                    .exists(),
                )
            ).all()
        for session_id, phase_id in missing:
            self.phase_ended(session_id, phase_id)

    def stop(self) -> None:
        """Finish the phase under way and end; what waits is caught up at the next start."""
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _run(self, session_id: str, phase_id: int) -> None:
        try:
            with self.context.database.reading() as db:
                rows = summary_rows(db, session_id, phase_id)
            with self.context.database.writing() as db:
                replace_rows(db, session_id, phase_id, rows)
        except Exception:
            log.exception("joint errors of phase %s of %s failed", phase_id, session_id)
        else:
            self.context.hub.publish(session_id, "session")


def summary_rows(db: Session, session_id: str, phase_id: int) -> list[JointErrorRow]:
    """The joint errors of a phase from its stored frames; none where it has no frames."""
    phase = db.get_one(Phase, (session_id, phase_id))
    delay_s = phase.latency_ms / 1000.0
    present: list[tuple[Rotations, Rotations]] = []
    command: list[tuple[Rotations, Rotations]] = []
    for epoch, actual in phase_frames(db, session_id, StreamName.ACTUAL, phase_id):
        history = _history(db, session_id, epoch, actual, delay_s)
        at_target, at_actual = _paired(history, actual)
        counted = actual.active[at_actual]
        got = actual.rotations[at_actual][counted]
        present.append((history.rotations[at_target][counted], got))
        command.append((_commanded(history, actual, at_actual, delay_s)[counted], got))
    return [
        *_rows(session_id, phase_id, "present", present),
        *_rows(session_id, phase_id, "command", command),
    ]


def replace_rows(db: Session, session_id: str, phase_id: int, rows: list[JointErrorRow]) -> None:
    """Store the summary of a phase in place of an older one."""
    db.execute(
        delete(JointErrorRow).where(
            JointErrorRow.session_id == session_id, JointErrorRow.phase_id == phase_id
        )
    )
    db.add_all(rows)


def _history(db: Session, session_id: str, epoch: int, actual: Frames, delay_s: float) -> Frames:
    """Target frames from one delay before the phase on, so that the first command is known."""
    finite = actual.times_s[np.isfinite(actual.times_s)]
    since_s = float(finite.min()) - delay_s - 1.0 if len(finite) else None
    pieces = [
        frames
        for _, frames in iter_frames(db, session_id, StreamName.TARGET, epoch, since_s=since_s)
    ]
    return concatenate(pieces)


def _paired(target: Frames, actual: Frames) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices of the frames of both streams that carry the same seq."""
    _, at_target, at_actual = np.intersect1d(
        target.seq, actual.seq, assume_unique=True, return_indices=True
    )
    return at_target, at_actual


def _commanded(
    history: Frames, actual: Frames, at_actual: NDArray[np.int64], delay_s: float
) -> Rotations:
    """The delayed command at the time of each paired actual frame; NaN where it is unknown."""
    query_s = actual.times_s[at_actual]
    commanded = np.full((len(query_s), 22, 4), np.nan)
    times_s, rotations = history.times_s, history.rotations
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
    session_id: str,
    phase_id: int,
    reference: str,
    pairs: list[tuple[Rotations, Rotations]],
) -> Iterator[JointErrorRow]:
    if not pairs:
        return
    summary = joint_error_summary(
        np.concatenate([wanted for wanted, _ in pairs]), np.concatenate([got for _, got in pairs])
    )
    for joint_index, joint in enumerate(summary.joints):
        for axis_index, axis in enumerate(summary.axes):
            at = (joint_index, axis_index)
            yield JointErrorRow(
                session_id=session_id,
                phase_id=phase_id,
                reference=reference,
                joint=joint,
                axis=axis,
                **_figures(summary, at),
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
