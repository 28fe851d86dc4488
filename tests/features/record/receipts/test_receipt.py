"""Tests of a receipt's verdict, over HTTP and as text."""

import json
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import delete, update
from sqlalchemy.orm import Session

from app.features.record.receipts.service import receipt_text
from app.features.record.telemetry import assign_epoch
from app.models import ClientReport, Phase, SessionEvent, TelemetryChunk, TelemetryStream
from app.wire import BODY_STREAMS, StreamName
from tests.features.builders import NOW
from tests.features.lab import Lab, ok
from tests.features.latency_builders import measured
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
    stored.change(
        lambda db: assign_epoch(db, stored.session_id, NOW, abilities=frozenset({"fingers"}))
    )
    # The runs that moved in the phases have announced nothing.
    assert problems() == []
    assert "actual_fingers       3         0         0        0" in receipt_text(stored.receipt())
    store(StreamName.TARGET, moving_values(9, 1), 2)
    store(StreamName.TARGET_FINGERS, resting_fingers(9), 2)
    (missing,) = problems()
    announced = "no frames of the actual fingers, which the headset announced"
    assert missing == f"phase 2, epoch 3: {announced}"


@pytest.mark.one_engine
def test_goals_that_were_announced_and_never_reported_are_a_gap(stored: StoredSession) -> None:
    """A run that announced reports of its goals and moved in a phase without any is named."""

    def problems() -> list[str]:
        return [one for one in stored.receipt().problems if "goals" in one]

    told = frozenset({"goals"})
    stored.change(lambda db: assign_epoch(db, stored.session_id, NOW, abilities=told))
    # It has not moved in a phase yet.
    assert problems() == []
    values = moving_values(9, 1)
    stored.change(
        lambda db: store_chunks(
            db, stored.session_id, StreamName.TARGET, range(9), values, epoch=3, phase_id=2
        )
    )
    gap = "no report of how the goals of the body are known, which the headset announced"
    assert problems() == [f"phase 2, epoch 3: {gap}"]
    store_report(stored, 0, {"kind": "goals"}, accepted=False)
    assert problems() == [f"phase 2, epoch 3: {gap}"]
    store_report(stored, 1, {"kind": "goals"}, accepted=True)
    assert problems() == []


def store_report(
    stored: StoredSession, seq: int, payload: dict[str, Any], *, accepted: bool
) -> None:
    """Store a report of epoch 3 as the server had accepted or refused it."""
    row = ClientReport(
        session_id=stored.session_id,
        epoch=3,
        seq=seq,
        type=payload["kind"],
        payload=payload,
        accepted=accepted,
        refusal=None if accepted else "it cannot be",
        received_at=NOW,
    )
    stored.change(lambda db: db.add(row))


@pytest.mark.one_engine
def test_a_refused_report_of_added_latency_does_not_count(stored: StoredSession) -> None:
    """The receipt has the most that accepted reports added, whatever a refused one says."""

    def added() -> tuple[float | None, float | None]:
        (one,) = stored.receipt().achieved_latency
        return one.headset_added_ms, one.headset_compensated_ms

    stored.change(
        lambda db: db.add(measured(db.get_one(Phase, (stored.session_id, 2)), achieved_s=0.1))
    )
    report = {"kind": "added_latency", "phase_id": 2, "added_s": 1.0, "compensated_s": 0.9}
    store_report(stored, 0, report, accepted=False)
    assert added() == (None, None)
    believed = {**report, "added_s": 0.02, "compensated_s": 0.0}
    store_report(stored, 1, believed, accepted=True)
    assert added() == (20.0, 0.0)


@pytest.mark.one_engine
def test_a_blinded_receipt_does_not_tell_a_copy_without_delay(stored: StoredSession) -> None:
    """Where the avatar's frames are the participant's own, a blinded reader cannot see it."""
    same = moving_values(50, 3)

    def store(db: Session) -> None:
        for stream in BODY_STREAMS:
            store_chunks(db, stored.session_id, stream, range(50), same, epoch=3)

    stored.change(store)
    receipt = stored.receipt()
    assert len({one.sha256 for one in receipt.streams if one.epoch == 3}) == 1
    shown = stored.receipt(blinded=True)
    assert {one.stream for one in shown.streams if one.sha256 is not None} == {"target"}
    hashes = [one.sha256 for one in shown.streams if one.sha256 is not None]
    assert len(set(hashes)) == len(hashes) == 3
    assert [(one.stream, one.stored, one.missing) for one in shown.streams] == [
        (one.stream, one.stored, one.missing) for one in receipt.streams
    ]


@pytest.mark.one_engine
def test_a_blinded_receipt_does_not_tell_how_often_the_avatar_failed(stored: StoredSession) -> None:
    """Flagged frames are counted for blinded readers only where they are the participant's own."""
    stored.change(lambda db: db.execute(update(TelemetryStream).values(frames_flagged=7)))
    assert {one.flagged for one in stored.receipt().streams} == {7}
    shown = stored.receipt(blinded=True)
    assert {(one.stream, one.flagged) for one in shown.streams} == {("target", 7), ("actual", None)}
    assert "actual         1       400       400        0        -" in receipt_text(shown)


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
