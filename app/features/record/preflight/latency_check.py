"""Whether the equipment delays by what it is told to: the newest phases that were measured.

The added latency is measured in every phase that moves enough, practice included, so the session
before is a self-test of today's. Where there is none yet, the equipment's calibrations are told.
Nothing here names a latency that was ordered or achieved: blinded operators see it too.
"""

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.calibrations import calibrations
from app.features.record.preflight.schemas import Check
from app.models import Phase, PhaseLatency, StudySession


def latency_check(db: Session, session: StudySession) -> Check:
    """The check of the achieved latency, from sessions of the same study.

    A scripted headset says nothing of a real one: simulated sessions are judged by their own kind.
    """
    simulated = session.kind == "simulated"
    measured = (
        select(PhaseLatency.session_id, PhaseLatency.flagged)
        .join(
            Phase,
            (Phase.session_id == PhaseLatency.session_id)
            & (Phase.phase_id == PhaseLatency.phase_id),
        )
        .join(StudySession, StudySession.id == PhaseLatency.session_id)
        .where(
            StudySession.study_id == session.study_id,
            (StudySession.kind == "simulated") == simulated,
            PhaseLatency.achieved_s.is_not(None),
            Phase.status == "done",
        )
    )
    newest = db.execute(measured.order_by(Phase.ended_at.desc()).limit(1)).first()
    if newest is None:
        return _unmeasured(db)
    of_session = measured.where(PhaseLatency.session_id == newest.session_id)
    off = [row.flagged for row in db.execute(of_session)]
    wrong = sum(off)
    return Check(
        key="latency",
        status="fail" if wrong else "ok",
        code="latency.off" if wrong else "latency.ok",
        value=len(off) - wrong,
        unit="phases",
        expected="at_least",
        limit=len(off),
    )


def _unmeasured(db: Session) -> Check:
    current = [one for one in calibrations(db) if one.current]
    return Check(
        key="latency",
        status="wait",
        code="latency.calibrated" if current else "latency.unmeasured",
        details=tuple(
            f"{one.equipment}: {one.motion_to_photon_ms:g} ms, {one.measured_on.isoformat()}"
            for one in current
        ),
    )
