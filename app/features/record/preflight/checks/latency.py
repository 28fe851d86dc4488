"""Check that the equipment achieves the latency that is set, from the last session measured.

The added latency is measured in every phase with enough movement, practice included, so the
previous session is a test of today's equipment. If there is none yet, the equipment's calibrations
are shown. No latency, set or achieved, is named here, because blinded operators see the list, too.
"""

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.calibrations import calibrations
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.models import Phase, PhaseLatency, StudySession
from app.texts import Words


def _latency(situation: Situation) -> Found:
    """Check the achieved latency in the last measured session of the same study.

    A scripted headset says nothing about a real one, so simulated sessions are compared only with
    each other.
    """
    db, session = situation.db, situation.session
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
    return Found(
        "off" if wrong else "ok",
        value=len(off) - wrong,
        unit="phases",
        expected="at_least",
        limit=len(off),
    )


def _unmeasured(db: Session) -> Found:
    current = [one for one in calibrations(db) if one.current]
    return Found(
        "calibrated" if current else "unmeasured",
        details=tuple(
            f"{one.equipment}: {one.motion_to_photon_ms:g} ms, {one.measured_on.isoformat()}"
            for one in current
        ),
    )


LATENCY = StateCheck(
    key="latency",
    title=Words(en="Latency", de="Latenz"),
    findings=(
        Finding(
            "unmeasured",
            "wait",
            Words(
                en="Measured in the first phase",
                de="Wird in der ersten Phase gemessen",
            ),
        ),
        Finding(
            "calibrated",
            "wait",
            Words(
                en="Calibrated; measured in the first phase",
                de="Kalibriert; wird in der ersten Phase gemessen",
            ),
        ),
        Finding(
            "off",
            "fail",
            Words(
                en="{{value}} of {{limit}} phases of the last session within tolerance",
                de="{{value}} von {{limit}} Phasen der letzten Sitzung innerhalb der Toleranz",
            ),
            remedy=Words(
                en="Check the latencies of the last session, and measure the latency of the "
                "equipment again.",
                de="Sehen Sie sich die Latenzen der letzten Sitzung an und messen Sie die Latenz "
                "der Geräte neu.",
            ),
        ),
        Finding(
            "ok",
            "ok",
            Words(
                en="{{value}} of {{limit}} phases of the last session within tolerance",
                de="{{value}} von {{limit}} Phasen der letzten Sitzung innerhalb der Toleranz",
            ),
        ),
    ),
    run=_latency,
)
