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
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.movement.humanoids import body_by_name, figure_by_hash, parsed_figure
from app.features.record.telemetry.encoding import DamagedChunkError, Frames
from app.features.record.telemetry.frames import (
    concatenate,
    decode_piece,
    iter_pieces,
    phase_frames,
)
from app.models import Phase, TelemetryChunk
from app.platform.access import session_by_id
from app.science.avatar.targets import HingeReference
from app.science.joint_error import ReferenceMotion
from app.science.skeleton import FINGER_COUNT, JOINT_COUNT
from app.wire import StreamName

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Run:
    """Both streams of one epoch of a phase; times in seconds of the epoch's clock.

    `hinges`: those of a physics avatar; None for a delayed copy. `fingers`: the frames of the
    target's and the actual fingers; None if no run of the phase recorded any.
    """

    epoch: int
    target: Frames
    actual: Frames
    hinges: HingeReference | None = None
    fingers: tuple[Frames, Frames] | None = None

    @cached_property
    def target_rotations(self) -> NDArray[np.float64]:
        """Return the target's local rotations (n, 22, 4), or (n, 52, 4) with fingers."""
        return _with_fingers(self.target, None if self.fingers is None else self.fingers[0])

    @cached_property
    def actual_rotations(self) -> NDArray[np.float64]:
        """Return the avatar's local rotations (m, 22, 4), or (m, 52, 4) with fingers."""
        return _with_fingers(self.actual, None if self.fingers is None else self.fingers[1])

    @cached_property
    def reference(self) -> ReferenceMotion:
        """Return the motion that the avatar should reproduce, for all target frames."""
        rotations = self.target_rotations
        if self.hinges is None:
            return ReferenceMotion(rotations)
        return self.hinges.recording(self.target.times_s, rotations)


def phase_runs(db: Session, session_id: str, phase_id: int, *, history_s: float) -> list[Run]:
    """Return the runs of a phase, with target frames from `history_s` before its first frame.

    If any of them recorded fingers, all have fingers, so that their rotations have one shape; a run
    that recorded none has no frames of them.
    """
    fingers = dict(phase_frames(db, session_id, StreamName.ACTUAL_FINGERS, phase_id))
    no_fingers = concatenate([], StreamName.ACTUAL_FINGERS) if fingers else None
    hinges = hinges_of(db, session_id, phase_id)
    return [
        Run(
            epoch,
            _target(db, session_id, epoch, StreamName.TARGET, actual, history_s),
            actual,
            hinges,
            _fingers(db, session_id, epoch, fingers.get(epoch, no_fingers), actual, history_s),
        )
        for epoch, actual in phase_frames(db, session_id, StreamName.ACTUAL, phase_id)
    ]


def _with_fingers(body: Frames, fingers: Frames | None) -> NDArray[np.float64]:
    """Join the rotations of a body with those of its fingers in the same frames.

    They are NaN in frames without fingers.
    """
    if fingers is None:
        return body.rotations
    joined = np.full((len(body), JOINT_COUNT + FINGER_COUNT, 4), np.nan)
    joined[:, :JOINT_COUNT] = body.rotations
    _, at_body, at_fingers = np.intersect1d(
        body.seq, fingers.seq, assume_unique=True, return_indices=True
    )
    joined[at_body, JOINT_COUNT:] = fingers.rotations[at_fingers]
    return joined


def _fingers(
    db: Session,
    session_id: str,
    epoch: int,
    actual_fingers: Frames | None,
    actual: Frames,
    history_s: float,
) -> tuple[Frames, Frames] | None:
    """Return the frames of target and actual fingers that belong to a run; None without any."""
    if actual_fingers is None:
        return None
    stream = StreamName.TARGET_FINGERS
    return _target(db, session_id, epoch, stream, actual, history_s), actual_fingers


def _target(
    db: Session,
    session_id: str,
    epoch: int,
    stream: StreamName,
    actual: Frames,
    history_s: float,
) -> Frames:
    finite = actual.times_s[np.isfinite(actual.times_s)]
    if not len(finite):
        return concatenate([], stream)
    since_s, until_s = float(finite.min()) - history_s, float(finite.max()) + 1.0
    return concatenate(list(_between(db, session_id, epoch, stream, since_s, until_s)), stream)


def _between(
    db: Session,
    session_id: str,
    epoch: int,
    stream: StreamName,
    since_s: float,
    until_s: float,
) -> Iterator[Frames]:
    """Yield the target frames of an interval of client time, rounded up to whole pieces."""
    for piece in iter_pieces(db, session_id, stream, epoch, since_s=since_s):
        # Iterate to the end: leaving the loop early would leave PostgreSQL's cursor open.
        if isinstance(piece, TelemetryChunk) and piece.t_first_s > until_s:
            continue
        try:
            yield decode_piece(piece)
        except DamagedChunkError as error:
            log.warning("%s of %s, seq %d: %s", stream, session_id, piece.seq_first, error)


def hinges_of(db: Session, session_id: str, phase_id: int | None = None) -> HingeReference | None:
    """Return the hinges of the session's avatar; None for a delayed copy.

    The body is the one that the phase wears, or without a phase that of the configuration. The
    first call in a process loads the compiler, which takes a second, so do not call it on the
    event loop. Raises NotFound if there is no such session.
    """
    phase = None if phase_id is None else db.get(Phase, (session_id, phase_id))
    return hinges_of_body(db, session_id, None if phase is None else phase.body)


def hinges_of_body(db: Session, session_id: str, body: str | None) -> HingeReference | None:
    """Return the hinges of a body that the session's avatar wears, as `hinges_of` does.

    `body` is its name; None for the body of the configuration.
    """
    content_hash = session_by_id(db, session_id).avatar_configuration_hash
    if content_hash is None:
        return None
    configuration = configuration_by_hash(db, content_hash)
    if body is None:
        figure = figure_by_hash(db, configuration.humanoid)
    else:
        figure = parsed_figure(body_by_name(db, body).figure)
    # Leave out parts that the model lacks, even if the configuration mentions them.
    parts = [part for part in configuration.parts if figure is None or part in figure.places_m]
    return HingeReference(configuration.in_force, parts)
