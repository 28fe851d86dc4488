"""Commit the batches of headsets' self-tests as telemetry is committed, and keep nothing of them.

A self-test shows how long a batch takes from the headset to the disk and back, so its batches share
the commits of all running sessions. They belong to no session: every commit deletes those of the
commit before, as folding deletes batches of a session, and closing the test deletes the last.
"""

from typing import NamedTuple, cast

from sqlalchemy import Table, delete
from sqlalchemy.orm import Session

from app.features.record.telemetry.ingest import Intake
from app.features.record.telemetry.positions import Outcome
from app.models import HeadsetTestBatch
from app.wire import BatchHeader, StreamPosition

TRIALS = cast("Table", HeadsetTestBatch.__table__)
NO_SESSION = ""
"""The session id of an arrival that belongs to none."""


class TrialContent(NamedTuple):
    """A batch of a self-test: its decoded header and its raw bytes."""

    trial_id: str
    header: BatchHeader
    message: bytes


class TrialEnd(NamedTuple):
    """The end of a self-test's sending, which deletes what is left of it."""

    trial_id: str


def store_trial(intake: Intake, trial: TrialContent, outcome: Outcome) -> None:
    """Store a batch of a self-test in place of those of the last commit, and acknowledge it."""
    if not intake.gathers(TRIALS, trial_id=trial.trial_id):
        forget_trial(intake.db, trial.trial_id)
    header = trial.header
    intake.gather(
        TRIALS,
        {
            "trial_id": trial.trial_id,
            "stream": str(header.stream),
            "seq_first": header.seq_first,
            "received_at": intake.now,
            "message": trial.message,
        },
    )
    position = StreamPosition(
        stream=str(header.stream), epoch=header.epoch, next_seq=header.seq_end
    )
    outcome.positions[position.stream, position.epoch] = position


def end_trial(intake: Intake, trial_id: str) -> None:
    """Delete what is left of a self-test, also what arrived with its end and is not written yet."""
    intake.flush()
    forget_trial(intake.db, trial_id)


def forget_trial(db: Session, trial_id: str | None = None) -> None:
    """Delete the batches of a self-test, or of all of them."""
    mine = () if trial_id is None else (TRIALS.c.trial_id == trial_id,)
    db.connection().execute(delete(TRIALS).where(*mine))
