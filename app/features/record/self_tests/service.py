"""Store self-tests of headsets with their verdicts, once each."""

from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, NotNow
from app.features.record.self_tests.consistency import require_consistent
from app.features.record.self_tests.schemas import SelfTestReport, SelfTestView, Verdict
from app.features.record.self_tests.verdicts import is_worn, verdicts, worst
from app.features.record.sessions import state_of
from app.models import HeadsetTest
from app.platform.access import session_by_id

CLOCK_TOLERANCE_S = 60.0


def add_self_test(db: Session, report: SelfTestReport, *, now: datetime) -> SelfTestView:
    """Store a report with its verdicts, or return the stored one if it was sent before.

    Raises Conflict if another report has its id, and InvalidInput if its figures cannot all be
    true.
    """
    stored = db.get(HeadsetTest, report.id, with_for_update=True)
    if stored is not None:
        return _same(stored, report)
    require_consistent(report, now=now)
    judged = verdicts(report)
    row = HeadsetTest(
        id=report.id,
        started_at=report.started_at,
        received_at=now,
        status=worst(judged),
        worn=is_worn(report),
        report=report.model_dump(mode="json"),
        verdicts=[verdict.model_dump(mode="json") for verdict in judged],
    )
    db.add(row)
    db.flush()
    return _view(row)


def self_tests(db: Session, *, most: int | None = None) -> list[SelfTestView]:
    """Return the self-tests, the last received first: all of them, or at most so many.

    The order is by the server's clock: a headset whose clock is ahead would hide newer tests.
    """
    order = (HeadsetTest.received_at.desc(), HeadsetTest.started_at.desc(), HeadsetTest.id)
    return [_view(row) for row in db.scalars(select(HeadsetTest).order_by(*order).limit(most))]


def require_no_phase(db: Session, session_id: str) -> None:
    """Raise NotNow while the session has a phase, whose data a self-test would disturb."""
    phase = state_of(session_by_id(db, session_id)).phase
    if phase is not None:
        raise NotNow(
            "a headset cannot be tested during a phase",
            value=str(phase.status),
            remedy="End the phase, or test the headset before or after the session.",
        )


def _same(stored: HeadsetTest, report: SelfTestReport) -> SelfTestView:
    view = _view(stored)
    if view.report != report:
        raise Conflict(
            "another self-test has this id already",
            value=report.id,
            remedy="Choose a new random id at the start of every test.",
        )
    return view


def clock_ahead_s(report: SelfTestReport, received_at: datetime) -> float | None:
    """Return how far the headset's clock is ahead of the server's at least; None up to a minute."""
    waited_s = (received_at - report.started_at).total_seconds() - report.duration_s
    return -waited_s if waited_s < -CLOCK_TOLERANCE_S else None


def _view(row: HeadsetTest) -> SelfTestView:
    report = SelfTestReport.model_validate(row.report)
    return SelfTestView(
        id=row.id,
        received_at=row.received_at,
        status=row.status,
        worn=row.worn,
        verdicts=tuple(Verdict.model_validate(one) for one in row.verdicts),
        report=report,
        clock_ahead_s=clock_ahead_s(report, row.received_at),
    )
