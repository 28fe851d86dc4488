"""Builders of phases with stored movement of known latency."""

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, encode_frames
from app.models import Phase, PhaseLatency, TelemetryChunk, TelemetryStream
from app.wire import VALUES_PER_FRAME, StreamName
from tests.features.builders import NOW
from tests.science.moving_bodies import Movement, delayed_copy, made_movement

RATE_HZ = 90.0
HISTORY_S = 2.0


def store_movement(
    db: Session,
    phase: Phase,
    latency_s: float,
    *,
    duration_s: float = 8.0,
    epoch: int = 1,
    clock_s: float = 0.0,
    movement: Movement | None = None,
) -> None:
    """Store both streams of one run of the client: two seconds before the phase, then the phase.

    `clock_s` is the run's clock at its first frame.
    """
    rng = np.random.default_rng(epoch)
    times_s = np.arange(0.0, HISTORY_S + duration_s, 1.0 / RATE_HZ)
    run = delayed_copy(times_s, (movement or made_movement(rng))(times_s), latency_s)
    before = len(run.target_times_s) - len(run.actual_times_s)
    # Before the phase the avatar is stored too; its movement there does not matter.
    actual = np.concatenate((run.target_rotations[:before], run.actual_rotations))
    for stream, rotations in (
        (StreamName.TARGET, run.target_rotations),
        (StreamName.ACTUAL, actual),
    ):
        store_stream(db, phase, stream, epoch, clock_s + times_s, rotations, before)


def store_stream(
    db: Session,
    phase: Phase,
    stream: StreamName,
    epoch: int,
    times_s: NDArray[np.float64],
    rotations: NDArray[np.float64],
    before: int,
) -> None:
    """Store rotations (n, 22, 4) as active frames; the first `before` frames have no phase."""
    values = np.zeros((len(times_s), VALUES_PER_FRAME), np.float32)
    values[:, 3:] = rotations.reshape(len(times_s), -1)
    db.add(
        TelemetryStream(
            session_id=phase.session_id,
            stream=stream,
            epoch=epoch,
            next_seq=len(times_s),
            frames_stored=len(times_s),
            frames_flagged=0,
            phase_id=phase.phase_id,
            active_s=1.0,
            first_at=NOW,
            last_at=NOW,
        )
    )
    for first, last, phase_id in ((0, before, 0), (before, len(times_s), phase.phase_id)):
        flags = np.full(last - first, 1 if phase_id else 0, np.uint8)
        db.add(
            TelemetryChunk(
                session_id=phase.session_id,
                stream=stream,
                epoch=epoch,
                seq_first=first,
                frame_count=last - first,
                phase_id=phase_id,
                values_per_frame=VALUES_PER_FRAME,
                t_first_s=float(times_s[first]),
                t_last_s=float(times_s[last - 1]),
                encoding=ENCODING,
                data=encode_frames(times_s[first:last], flags, values[first:last]),
            )
        )
    db.flush()


def measured(phase: Phase, achieved_s: float | None, *, flagged: bool = False) -> PhaseLatency:
    """Return a latency row of a phase; without a latency it has a reason."""
    return PhaseLatency(
        session_id=phase.session_id,
        phase_id=phase.phase_id,
        ordered_s=phase.latency_ms / 1000.0,
        achieved_s=achieved_s,
        low_s=None if achieved_s is None else achieved_s - 0.0004,
        high_s=None if achieved_s is None else achieved_s + 0.0004,
        movement_s=3.25 if achieved_s is None else 58.0,
        frame_s=1 / RATE_HZ,
        samples=5400,
        flagged=flagged,
        reason="3.2 s of movement." if achieved_s is None else None,
    )
