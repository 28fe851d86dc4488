"""The verdict of a receipt, over HTTP and on the command line."""

import json

import pytest
from sqlalchemy import delete, update

from app.features.record.receipts.service import receipt_text
from app.models import Phase, SessionEvent, TelemetryChunk
from tests.features.lab import Lab, ok
from tests.features.record.receipts.conftest import Kept


def test_a_changed_event_is_told(kept: Kept) -> None:
    """An event that was edited in SQL breaks the chain, and the receipt says where."""
    kept.change(
        lambda db: db.execute(update(SessionEvent).where(SessionEvent.seq == 1).values(actor="x"))
    )
    receipt = kept.receipt()
    assert not receipt.chain_ok
    assert "the event log was changed: its hash chain breaks at event 1" in receipt.problems


def test_a_log_whose_end_was_cut_off_is_told(kept: Kept) -> None:
    """The session remembers how many events it had."""
    kept.change(lambda db: db.execute(delete(SessionEvent).where(SessionEvent.seq == 2)))
    assert not kept.receipt().chain_ok


def test_a_phase_without_movement_is_told(kept: Kept) -> None:
    """A phase that counts and recorded nothing cannot pass for a complete one."""
    assert "phase 2: no frames of the actual body" in kept.receipt().problems
    kept.change(lambda db: db.execute(update(Phase).values(status="voided")))
    assert not any("no frames" in problem for problem in kept.receipt().problems)


@pytest.mark.one_engine
def test_a_receipt_is_json_and_text(kept: Kept) -> None:
    """Both tell the verdict and every stream."""
    kept.change(lambda db: db.execute(delete(TelemetryChunk).where(TelemetryChunk.epoch == 2)))
    receipt = kept.receipt()
    told = json.loads(json.dumps(receipt.as_json()))
    assert told["complete"] is False
    assert {"stream": "target", "epoch": 2, "sent": 100, "stored": 0, "missing": 100}.items() <= (
        told["streams"][-1].items()
    )
    text = receipt_text(receipt)
    assert text.startswith(f"NOT COMPLETE  session {kept.session_id}")
    assert "target         2       100         0      100" in text


@pytest.mark.one_engine
def test_a_new_session_has_an_empty_receipt(lab: Lab) -> None:
    """Nothing was promised, nothing is missing."""
    session = lab.join()
    receipt = ok(lab.operator.get(f"/api/sessions/{session['id']}/receipt"))
    assert (receipt["complete"], receipt["streams"], receipt["problems"]) == (True, [], [])


@pytest.mark.one_engine
def test_only_who_is_signed_in_gets_a_receipt(lab: Lab) -> None:
    """A stranger is refused, an unknown session is not found."""
    session = lab.join()
    assert lab.stranger().get(f"/api/sessions/{session['id']}/receipt").status_code == 401
    assert lab.operator.get("/api/sessions/nothing/receipt").status_code == 404
