"""Tests of a receipt's verdict, over HTTP and as text."""

import json

import pytest
from sqlalchemy import delete, update

from app.features.record.receipts.service import receipt_text
from app.features.record.telemetry import assign_epoch
from app.models import Phase, SessionEvent, TelemetryChunk
from tests.features.builders import NOW
from tests.features.lab import Lab, ok
from tests.features.record.receipts.conftest import StoredSession


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
    """A phase without fingers is a problem only if a headset has announced that it sends them."""
    assert not any("fingers" in problem for problem in stored.receipt().problems)
    stored.change(lambda db: assign_epoch(db, stored.session_id, NOW, fingers=True))
    receipt = stored.receipt()
    announced = "phase 2: no frames of the target fingers, which the headset announced"
    assert announced in receipt.problems
    assert {"target_fingers", "actual_fingers"} < {one.stream for one in receipt.streams}
    assert "actual_fingers       3         0         0        0" in receipt_text(receipt)


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
