"""Tests of a receipt's verdict, over HTTP and as text."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import delete, update

from app.features.record.receipts.service import receipt_text
from app.features.record.telemetry import assign_epoch
from app.models import Phase, SessionEvent, TelemetryChunk
from app.wire import StreamName
from tests.features.builders import NOW
from tests.features.lab import Lab, ok
from tests.features.movement_builders import moving_values, store_chunks
from tests.features.record.receipts.conftest import StoredSession
from tests.wire.samples import resting_fingers


def test_a_changed_event_is_reported(stored: StoredSession) -> None:
    """A receipt reports at which event an edited event log breaks its chain."""
    stored.change(
        lambda db: db.execute(update(SessionEvent).where(SessionEvent.seq == 1).values(actor="x"))
    )
    receipt = stored.receipt()
    assert not receipt.chain_ok
    assert "the event log was changed: its hash chain breaks at event 1" in receipt.problems


def test_a_truncated_event_log_is_reported(stored: StoredSession) -> None:
    """A receipt reports an event log whose last event was deleted."""
    stored.change(lambda db: db.execute(delete(SessionEvent).where(SessionEvent.seq == 2)))
    assert not stored.receipt().chain_ok


def test_a_phase_without_movement_is_reported(stored: StoredSession) -> None:
    """A receipt reports a phase without frames, unless the phase is void."""
    assert "phase 2: no frames of the actual body" in stored.receipt().problems
    stored.change(lambda db: db.execute(update(Phase).values(status="voided")))
    assert not any("no frames" in problem for problem in stored.receipt().problems)


@pytest.mark.one_engine
def test_announced_fingers_that_are_missing_are_reported(stored: StoredSession) -> None:
    """Fingers are missing only where a run of a phase lacks those that it has announced."""

    def problems() -> list[str]:
        return [one for one in stored.receipt().problems if "fingers" in one]

    def store(stream: StreamName, values: NDArray[np.float32], phase_id: int) -> None:
        stored.change(
            lambda db: store_chunks(
                db, stored.session_id, stream, range(9), values, epoch=3, phase_id=phase_id
            )
        )

    assert problems() == []
    stored.change(lambda db: assign_epoch(db, stored.session_id, NOW, fingers=True))
    # The runs that moved in the phases have announced nothing.
    assert problems() == []
    assert "actual_fingers       3         0         0        0" in receipt_text(stored.receipt())
    store(StreamName.TARGET, moving_values(9, 1), 2)
    store(StreamName.TARGET_FINGERS, resting_fingers(9), 2)
    (missing,) = problems()
    announced = "no frames of the actual fingers, which the headset announced"
    assert missing == f"phase 2, epoch 3: {announced}"


@pytest.mark.one_engine
def test_a_receipt_is_json_and_text(stored: StoredSession) -> None:
    """A receipt's JSON and text both have the verdict and the counts of every stream."""
    stored.change(lambda db: db.execute(delete(TelemetryChunk).where(TelemetryChunk.epoch == 2)))
    receipt = stored.receipt()
    reply = json.loads(json.dumps(receipt.as_json()))
    assert reply["complete"] is False
    assert {"stream": "target", "epoch": 2, "sent": 100, "stored": 0, "missing": 100}.items() <= (
        reply["streams"][-1].items()
    )
    text = receipt_text(receipt)
    assert text.startswith(f"NOT COMPLETE  session {stored.session_id}")
    assert "target         2       100         0      100" in text


@pytest.mark.one_engine
def test_a_new_session_has_an_empty_receipt(lab: Lab) -> None:
    """The receipt of a new session is complete and empty."""
    session = lab.join()
    receipt = ok(lab.operator.get(f"/api/sessions/{session['id']}/receipt"))
    assert (receipt["complete"], receipt["streams"], receipt["problems"]) == (True, [], [])


@pytest.mark.one_engine
def test_a_receipt_needs_a_login(lab: Lab) -> None:
    """A receipt needs a login, and that of an unknown session is not found."""
    session = lab.join()
    assert lab.stranger().get(f"/api/sessions/{session['id']}/receipt").status_code == 401
    assert lab.operator.get("/api/sessions/nothing/receipt").status_code == 404
