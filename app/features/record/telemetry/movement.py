"""Read a phase's movement for its summaries: what the avatar did, and what it should have done.

A phase has one `Run` for each epoch that took part in it; every epoch has its own clock. The actual
body's frames are those of the phase. The target's frames begin earlier, since the avatar's movement
at the start of a phase was commanded before it.
"""

import logging
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.movement.humanoids import figure_by_hash
from app.features.record.telemetry.encoding import DamagedChunkError, Frames
from app.features.record.telemetry.frames import (
    concatenate,
    decode_piece,
    iter_pieces,
    phase_frames,
)
from app.models import TelemetryChunk
from app.platform.access import session_by_id
from app.science.avatar.targets import HingeReference
from app.science.joint_error import ReferenceMotion
from app.wire import StreamName

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Run:
    """Both streams of one epoch of a phase; times in seconds of the epoch's clock.

    `hinges`: those of a physics avatar; None for a delayed copy.
    """

    epoch: int
    target: Frames
    actual: Frames
    hinges: HingeReference | None = None

    @cached_property
    def reference(self) -> ReferenceMotion:
        """Return the motion that the avatar should reproduce, for all target frames."""
        rotations = self.target.rotations
        if self.hinges is None:
            return ReferenceMotion(rotations)
        return self.hinges.recording(self.target.times_s, rotations)


def phase_runs(db: Session, session_id: str, phase_id: int, *, history_s: float) -> list[Run]:
    """Return the runs of a phase, with target frames from `history_s` before its first frame."""
    hinges = hinges_of(db, session_id)
    return [
        Run(epoch, _target(db, session_id, epoch, actual, history_s), actual, hinges)
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
    """Yield the target frames of an interval of client time, rounded up to whole pieces."""
    for piece in iter_pieces(db, session_id, StreamName.TARGET, epoch, since_s=since_s):
        # Iterate to the end: leaving the loop early would leave PostgreSQL's cursor open.
        if isinstance(piece, TelemetryChunk) and piece.t_first_s > until_s:
            continue
        try:
            yield decode_piece(piece)
        except DamagedChunkError as error:
            log.warning("target of %s, seq %d: %s", session_id, piece.seq_first, error)


def hinges_of(db: Session, session_id: str) -> HingeReference | None:
    """Return the hinges of the session's avatar configuration; None for a delayed copy.

    The first call in a process loads the compiler, which takes a second, so do not call it on the
    event loop. Raises NotFound if there is no such session.
    """
    content_hash = session_by_id(db, session_id).avatar_configuration_hash
    if content_hash is None:
        return None
    configuration = configuration_by_hash(db, content_hash)
    figure = figure_by_hash(db, configuration.humanoid)
    # Leave out parts that the model lacks, even if the configuration mentions them.
    parts = [part for part in configuration.parts if figure is None or part in figure.places_m]
    return HingeReference(configuration.in_force, parts)
