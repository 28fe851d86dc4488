"""Check the record after an outage and format its figures."""

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import select

from app.models import AlarmRow
from tests.faults.outage import Watch
from tests.faults.record import record_of
from tests.faults.streaming import StreamingHeadset
from tests.rehearsal.ledger import Reconciliation, reconcile
from tests.support.server import LiveServer


def reconciled(server: LiveServer, headsets: Sequence[StreamingHeadset]) -> list[Reconciliation]:
    """Compare each headset's journal with the stored record."""
    with record_of(server) as db:
        return [reconcile(db, headset.session_id, headset.ledger) for headset in headsets]


def check_outage(watch: Watch, found: Sequence[Reconciliation]) -> None:
    """Assert that an outage lost no data and that the server responded correctly.

    Everything sent is stored exactly once; reads continued; no response had status 500; requests
    that would start something were rejected with a message.
    """
    for one in found:
        assert one == Reconciliation(one.sent, one.sent, one.sent, 0, 0, 0, 0), one
        assert one.sent > 0
    assert watch.acked_during == 0
    assert watch.console == ["ok", "failing", "ok"]
    assert {status for what, status in watch.answers if what == "reads"} == {200}
    assert {status for what, status in watch.answers if what == "writes"} <= {200, 201, 503}
    assert len(watch.refusals) == 3
    for refusal in watch.refusals:
        assert refusal["code"] == "not_durable", refusal
        assert watch.reason in refusal["message"], refusal
        assert refusal["remedy"], refusal


def check_recorded(server: LiveServer, headsets: Sequence[StreamingHeadset], reason: str) -> None:
    """Assert that each connected session has a raised and a cleared alarm about the outage."""
    with record_of(server) as db:
        rows = db.scalars(select(AlarmRow).where(AlarmRow.code == "storage")).all()
    for headset in headsets:
        own = sorted((row for row in rows if row.session_id == headset.session_id), key=_at)
        assert [row.state for row in own] == ["raised", "cleared"]
        assert {row.message for row in own} == {reason}
        assert (own[1].at - own[0].at).total_seconds() >= 1.0


def _at(row: AlarmRow) -> datetime:
    return row.at


def outage_figures(name: str, watch: Watch, found: Sequence[Reconciliation]) -> str:
    """Format the figures of an outage in a few lines."""
    answers = ", ".join(
        f"{what} {status}: {count}" for (what, status), count in sorted(watch.answers.items())
    )
    return (
        f"\n{name} ({watch.reason})\n"
        f"  acked {sum(one.acked for one in found)}, lost {sum(one.lost for one in found)}, "
        f"twice {sum(one.duplicated for one in found)}, "
        f"acked while nothing could be stored {watch.acked_during}, "
        f"longest queue of a headset {watch.longest_queue} messages\n"
        f"  alarm {watch.noticed_s:.2f} s after the cause, {watch.alarm_s:.2f} s after the first "
        f"commit that failed, refusal {watch.refusal_s:.2f} s; "
        f"well again {watch.recovery_s:.2f} s, started {watch.restart_s:.2f} s after the cause "
        f"was gone\n"
        f"  {answers}; longest wait of a write {watch.longest_wait_s:.2f} s\n"
    )
