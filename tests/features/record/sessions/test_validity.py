"""Tests of which completed sessions are valid, and which give their slot back."""

from dataclasses import replace

import pytest
from sqlalchemy import delete
from sqlalchemy.orm import Session

from app.features.record.doubts import OBSERVED
from app.features.record.ledger import Shortfall, close_attempt
from app.features.record.sessions import judge_again
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import state_to_json
from app.features.record.sessions.engine.state import SessionState, SessionStatus, StepStatus
from app.features.record.sessions.validity import PhaseDelay, judged
from app.models import AlarmRow, Phase, PhaseLatency, StudySession
from app.protocol import ValidWhen
from tests.features.lab import STUDY, Json, Lab, ok
from tests.features.latency_builders import measured
from tests.features.record.questionnaires.forms import ANSWERS, enter
from tests.features.record.sessions.engine_run import PLAN, Run, index_of
from tests.features.session_filler import NOW
from tests.protocol.helpers import BEFORE_RULES, edited, study

FORMS = "  forms: [karas2020]\n"
WITH_LATENCY = (FORMS, f"{FORMS}  achieved_latency: {{reported: true}}\n")
"""The shipped rules, and a latency that could be measured in every task."""
RULES = study(WITH_LATENCY).valid_when or ValidWhen(forms=("karas2020",))
TASKS = [step for step in PLAN if step.kind == "task"]


def done() -> SessionState:
    """Return the state of a session with every task and form completed."""
    run = Run()
    for step in TASKS:
        run.begin(step.key).finish()
    steps = tuple(replace(one, status=StepStatus.DONE) for one in run.state.steps)
    return replace(run.state, status=SessionStatus.COMPLETED, current=None, steps=steps)


def delays(state: SessionState, achieved_s: float | None = 0.2) -> dict[int, PhaseDelay]:
    """Return the same achieved latency for every phase, whose set latency is 0.1 s."""
    return {one.phase_id: PhaseDelay(0.1, achieved_s) for one in state.ended_phases}


def skip_all(lab: Lab, view: Json) -> Json:
    """Skip every step of a session, which completes it."""
    view = lab.command(view, "start")
    while view["status"] == "active":
        view = lab.command(view, "skip", reason="nobody was there")
    return view


def ledger(lab: Lab) -> list[Json]:
    """Return the slots of the ledger of people."""
    slots: list[Json] = ok(lab.operator.get(f"/api/studies/{STUDY}/ledger?kind=people"))["slots"]
    return slots


def with_latency(lab: Lab) -> Lab:
    """Store a version of the study that also requires a measured latency."""
    yaml = edited(WITH_LATENCY)
    ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": yaml}))
    return lab


def complete(db: Session, view: Json) -> StudySession:
    """Store a session as completed, with a row for its first phase."""
    session = db.get_one(StudySession, view["id"])
    state = done()
    session.status, session.snapshot = "completed", state_to_json(state)
    close_attempt(db, session, "completed", NOW)
    phase = state.ended_phases[0]
    step = PLAN[phase.step]
    db.add(
        Phase(
            session_id=session.id,
            phase_id=phase.phase_id,
            step_index=step.index,
            step_key=step.key,
            attempt=1,
            kind="task",
            limb="hand",
            block=1,
            condition=step.condition,
            latency_ms=100.0,
            status="done",
            prepared_at=NOW,
        )
    )
    db.flush()
    return session


def measure(db: Session, session: StudySession, achieved_s: float | None) -> None:
    """Store the latency of a session's first phase and reassess its validity."""
    phase = db.get_one(Phase, (session.id, 1))
    db.execute(delete(PhaseLatency).where(PhaseLatency.session_id == session.id))
    db.add(measured(phase, achieved_s))
    db.flush()
    judge_again(db, session, ())


def test_a_complete_session_is_valid() -> None:
    """A session with every task and form done is valid, also before its latency is measured."""
    state = done()
    assert judged(RULES, PLAN, state, delays(state)) == ()
    assert judged(RULES, PLAN, state, {}) == ()


def test_shortfalls_are_listed_in_the_order_of_the_steps() -> None:
    """Skipped and short phases, unanswered forms and missing latencies are listed in step order."""
    state = done()
    short, last = (TASKS[index].index for index in (1, 5))
    form = index_of("block2.hand.karas2020")
    statuses = {TASKS[0].index: StepStatus.SKIPPED, form: StepStatus.SKIPPED}
    state = replace(
        state,
        steps=tuple(
            replace(one, status=statuses.get(index, one.status))
            for index, one in enumerate(state.steps)
        ),
        ended_phases=tuple(
            replace(one, active_s=12.5) if one.step == short else one for one in state.ended_phases
        ),
    )
    existing = delays(state)
    existing[state.ended_phases[-1].phase_id] = PhaseDelay(0.1, None)
    found = judged(RULES, PLAN, state, existing)
    assert [(one.code, one.step) for one in found] == [
        ("phase_skipped", TASKS[0].key),
        ("phase_short", PLAN[short].key),
        ("form_skipped", "block2.hand.karas2020"),
        ("latency_missing", PLAN[last].key),
    ]
    assert [one.words() for one in found] == [
        "block 1, hand task: skipped",
        "block 1, foot task: 12.5 s of active time, at least 54 s needed",
        "block 2, hand task: questionnaire karas2020 not answered",
        "block 3, foot task: no achieved latency could be measured",
    ]


def test_a_participants_session_without_consent_is_not_valid() -> None:
    """A session without consent is not valid, unless it has no participant."""
    state = done()
    consent = next(step.index for step in PLAN if step.kind == "consent")
    steps = tuple(
        replace(one, status=StepStatus.SKIPPED) if index == consent else one
        for index, one in enumerate(state.steps)
    )
    state = replace(state, steps=steps)
    assert [one.code for one in judged(RULES, PLAN, state, {})] == ["consent_skipped"]
    assert judged(RULES, PLAN, state, {}, of_people=False) == ()


def test_a_latency_outside_the_tolerance_is_a_shortfall() -> None:
    """A latency that is 100 ms off is within a tolerance of 101 ms and outside one of 99 ms."""
    state = done()
    for tolerance_ms, count in ((101.0, 0), (99.0, 6)):
        rules = ValidWhen.model_validate_json(
            '{"phases": [{"phase": "hand"}, {"phase": "foot"}], '
            f'"achieved_latency": {{"reported": false, "tolerance_ms": {tolerance_ms}}}}}'
        )
        found = judged(rules, PLAN, state, delays(state))
        assert [one.code for one in found] == ["latency_off"] * count
        assert judged(rules, PLAN, state, delays(state, None)) == ()


def test_a_repeated_task_counts_by_its_last_attempt() -> None:
    """A repeated task is assessed by its last attempt; the latency of the void one is ignored."""
    run = Run().begin(TASKS[0].key).finish()
    run.do(c.Redo(step=TASKS[0].index, content=c.ContentRef("content", "hash")))
    run.begin(TASKS[0].key).finish()
    found = judged(RULES, PLAN, run.state, {1: PhaseDelay(0.1, None)})
    assert TASKS[0].key not in [one.step for one in found]


@pytest.mark.one_engine
def test_a_session_with_every_task_skipped_gives_its_slot_back(fresh_lab: Lab) -> None:
    """A completed session whose tasks were all skipped is not valid and gives its slot back."""
    lab = fresh_lab
    view = skip_all(lab, lab.join())
    assert view["status"] == "completed"
    codes = [one["code"] for one in view["shortfalls"]]
    assert codes == ["consent_skipped", *["phase_skipped", "form_skipped"] * 6]
    slot = ledger(lab)[0]
    assert (slot["state"], slot["attempts"][0]["outcome"]) == ("free", "invalid")
    assert slot["attempts"][0]["shortfalls"] == view["shortfalls"]
    words = [Shortfall.model_validate(one).words() for one in view["shortfalls"][:2]]
    assert words == ["no consent on record", "block 1, hand task: skipped"]
    assert lab.join()["slot"]["index"] == 0


@pytest.mark.one_engine
def test_a_study_without_validity_rules_keeps_the_slot(fresh_lab: Lab) -> None:
    """In a study without validity rules a completed session keeps its slot."""
    lab = fresh_lab
    ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": BEFORE_RULES}))
    view = skip_all(lab, lab.join())
    assert (view["status"], view["shortfalls"]) == ("completed", None)
    slot = ledger(lab)[0]
    assert (slot["state"], slot["attempts"][0]["outcome"]) == ("completed", "completed")


def test_a_later_latency_reassesses_the_session(fresh_lab: Lab) -> None:
    """A latency that is measured later makes a session valid or not, and its slot follows."""
    lab = with_latency(fresh_lab)
    view = lab.join()
    with lab.database.writing() as db:
        session = complete(db, view)
        judge_again(db, session, ())
        assert session.shortfalls == []
    assert ledger(lab)[0]["state"] == "completed"
    for achieved_s, outcome in ((None, "invalid"), (0.1, "completed")):
        with lab.database.writing() as db:
            measure(db, db.get_one(StudySession, view["id"]), achieved_s)
        assert ledger(lab)[0]["attempts"][0]["outcome"] == outcome
    assert lab.view(view["id"])["shortfalls"] == []


def test_a_slot_taken_by_another_session_is_not_returned(fresh_lab: Lab) -> None:
    """A session that becomes valid after its slot was taken by another stays without a slot."""
    lab = with_latency(fresh_lab)
    view = lab.join()
    with lab.database.writing() as db:
        measure(db, complete(db, view), None)
    other = lab.join()
    assert other["slot"]["index"] == view["slot"]["index"]
    with lab.database.writing() as db:
        measure(db, db.get_one(StudySession, view["id"]), 0.1)
    slot = ledger(lab)[0]
    assert [one["outcome"] for one in slot["attempts"]] == ["invalid", "open"]
    assert lab.view(view["id"])["shortfalls"] == []


@pytest.mark.one_engine
def test_a_session_ended_by_a_form_is_checked_for_doubts(fresh_lab: Lab) -> None:
    """A session that ends with a form is assessed with the doubts about its headset."""
    lab = fresh_lab
    last = "    - {step: debrief, text: debrief}\n"
    text = edited((last, f"{last}    - {{step: form, instrument: karas2020}}\n"))
    ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": text}))
    view = lab.command(lab.join(), "start")
    while view["current"]["index"] < len(view["steps"]) - 1:
        view = lab.command(view, "skip", reason="nobody was there")
    row = {"severity": "critical", "state": "raised", "message": "an epoch nobody gave out"}
    with lab.database.writing() as db:
        db.add(AlarmRow(id="a", session_id=view["id"], code=OBSERVED, at=NOW, **row))
    ok(enter(lab, view["id"], ANSWERS))
    view = lab.view(view["id"])
    assert view["status"] == "completed"
    assert "headset_doubtful" in [one["code"] for one in view["shortfalls"]]
