"""Tests of the receipt of a rehearsed session, compared with what its headset sent."""

import hashlib

import pytest
from sqlalchemy.orm import Session

from app.features.record.receipts import receipt_of
from app.features.record.receipts.service import SessionReceipt
from app.wire.messages import REPORT_STREAM
from tests.rehearsal.performed import Performed


@pytest.fixture
def receipt(performed: Performed, db: Session) -> SessionReceipt:
    """Provide the receipt, computed from the record alone."""
    return receipt_of(db, performed.session_id)


def test_the_session_is_complete(receipt: SessionReceipt) -> None:
    """The receipt of an undisturbed session is complete, without problems and with a valid log."""
    assert receipt.problems == ()
    assert receipt.complete
    assert receipt.chain_ok


def test_the_receipt_counts_what_the_headset_sent(
    performed: Performed, receipt: SessionReceipt
) -> None:
    """The receipt's counts equal what the headset sent, by stream and epoch."""
    told = {(one.stream, one.epoch): (one.sent, one.stored) for one in receipt.streams}
    sent = {key: len(known) for key, known in performed.ledger.sent.items()}
    assert told == {key: (count, count) for key, count in sent.items()}
    assert any(stream == REPORT_STREAM for stream, _ in told)
    assert len({one.sha256 for one in receipt.streams} - {hashlib.sha256().hexdigest()}) >= 3


def test_every_completion_follows_from_its_contacts(
    performed: Performed, receipt: SessionReceipt
) -> None:
    """In each of the six task phases, every completion follows from the stored contacts."""
    assert len(receipt.completions) == 6
    assert all(one.agree for one in receipt.completions)
    rederived = sum(one.rederived for one in receipt.completions)
    assert rederived == performed.report["completions"] > 0
