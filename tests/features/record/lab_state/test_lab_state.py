"""Tests of the lab's state: progress counts what counts, attention names what was left."""

from datetime import timedelta

from sqlalchemy import select

from app.features.record.lab_state.service import LabState, lab_state
from app.models import Participant, StudySession
from app.platform.access import Caller, visible_to
from tests.features.builders import NOW, STUDY, SessionSpec, build_session, build_study
from tests.features.lab import Lab, ok

EVERYBODY = Caller("a", "admin", "admin")
NOBODY = Caller("b", "elsewhere", "operator", all_studies=False)
LATER = NOW + timedelta(days=3)


def _state(lab: Lab, caller: Caller = EVERYBODY) -> LabState:
    with lab.database.reading() as db:
        return lab_state(db, visible_to(caller), NOW, LATER)


def _filled(lab: Lab) -> None:
    with lab.database.writing() as db:
        build_study(db)
        build_session(db, SessionSpec("P-0001"))
        build_session(db, SessionSpec("P-0002", status="withdrawn"))
        build_session(db, SessionSpec("P-0003", status="planned"))
        build_session(db, SessionSpec("P-0004", status="active"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
        planned = select(StudySession).where(StudySession.status == "planned")
        db.scalars(planned).one().started_at = None


def test_progress_counts_people_who_completed_of_the_places(fresh_lab: Lab) -> None:
    """Of twelve places one is filled: neither simulated people nor withdrawn ones count."""
    _filled(fresh_lab)
    (progress,) = _state(fresh_lab).studies
    assert (progress.study_key, progress.completed, progress.planned) == (STUDY, 1, 12)
    assert (progress.running, progress.preregistered) == (1, False)


def test_attention_names_what_was_left_and_why(fresh_lab: Lab) -> None:
    """A session left open, one never started and a withdrawal are listed, a complete one is not."""
    _filled(fresh_lab)
    found = {(one.participant_code, one.concern) for one in _state(fresh_lab).attention}
    assert found == {
        ("P-0002", "ended_early"),
        ("P-0003", "never_started"),
        ("P-0004", "left_open"),
    }


def test_a_reader_sees_only_their_own_studies(fresh_lab: Lab) -> None:
    """Somebody who is a member of no study gets an empty lab."""
    _filled(fresh_lab)
    state = _state(fresh_lab, NOBODY)
    assert (state.studies, state.today, state.attention) == ([], [], [])


def test_todays_sessions_are_those_since_the_readers_midnight(fresh_lab: Lab) -> None:
    """The endpoint lists a session that was just made, but none of last month."""
    _filled(fresh_lab)
    with fresh_lab.database.writing() as db:
        old = select(StudySession).join(Participant).where(Participant.code == "P-0001")
        session = db.scalars(old).one()
        session.created_at = session.started_at = session.ended_at = NOW - timedelta(days=30)
    made = fresh_lab.join(kind="test")["participant_code"]
    midnight = fresh_lab.context.clock.utc_now() - timedelta(hours=1)
    state = ok(fresh_lab.operator.get("/api/lab", params={"since": midnight.isoformat()}))
    codes = [one["participant_code"] for one in state["today"]]
    assert codes[0] == made
    assert "P-0001" not in codes
