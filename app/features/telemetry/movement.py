"""A phase's movement as it is summarised: what the avatar did, and what it was asked to before.

A phase has one run for each run of the client that took part in it; every run has a clock of its
own. The actual body's frames are those of the phase. The target's begin earlier, since what the
avatar does at the start of a phase was asked for before it.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from sqlalchemy.orm import Session

from app.features.telemetry.encoding import Frames
from app.features.telemetry.frames import concatenate, iter_frames, phase_frames
from app.wire import StreamName


@dataclass(frozen=True)
class Run:
    """Both streams of one run of the client; times in s of its clock."""

    epoch: int
    target: Frames
    actual: Frames


def phase_runs(db: Session, session_id: str, phase_id: int, *, history_s: float) -> list[Run]:
    """The runs of a phase, with target frames from `history_s` before its first frame on."""
    return [
        Run(epoch, _target(db, session_id, epoch, actual, history_s), actual)
        for epoch, actual in phase_frames(db, session_id, StreamName.ACTUAL, phase_id)
    ]


def _target(db: Session, session_id: str, epoch: int, actual: Frames, history_s: float) -> Frames:
    finite = actual.times_s[np.isfinite(actual.times_s)]
    if not len(finite):
        return concatenate([])
    since_s, until_s = float(finite.min()) - history_s, float(finite.max()) + 1.0
    return concatenate(list(_between(db, session_id, epoch, since_s, until_s)))


def _between(
    db: Session, session_id: str, epoch: int, since_s: float, until_s: float
) -> Iterator[Frames]:
    """Target frames of a stretch of the client's time; pieces are whole, so that some are more."""
    for _, frames in iter_frames(db, session_id, StreamName.TARGET, epoch, since_s=since_s):
        # What came later in the session would be read for nothing. One odd time is not "later".
        finite = frames.times_s[np.isfinite(frames.times_s)]
        if len(finite) and float(np.median(finite)) > until_s:
            return
        yield frames
