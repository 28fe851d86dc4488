"""Tests of commands over HTTP: concurrency, repetition and refusals."""

import uuid
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from sqlalchemy import func, select

from app.features.record.cockpit.watching import live_figures
from app.features.record.sessions.engine.commands import Report
from app.features.record.sessions.service import apply_command
from app.models import SessionContent, StudySession
from app.platform.access import session_by_id
from tests.features.lab import STUDY, Json, Lab, error, ok

BOTH = range(2)


@pytest.fixture
def planned(lab: Lab) -> Json:
    """Return a session that is planned."""
    return lab.join()


def started(lab: Lab, session_id: str) -> list[Json]:
    """Return the session's events of type `session_started`."""
    return [event for event in lab.events(session_id) if event["type"] == "session_started"]


def contents(lab: Lab, session_id: str, kind: str) -> int:
    """Return how many contents of a kind are stored for a session."""
    with lab.database.reading() as db:
        return int(
            db.scalar(
                select(func.count())
                .select_from(SessionContent)
                .where(SessionContent.session_id == session_id, SessionContent.kind == kind)
            )
            or 0
        )


def test_only_one_of_two_simultaneous_starts_succeeds(lab: Lab, planned: Json) -> None:
    """Of two simultaneous starts one succeeds; the other gets 409 `stale` with what changed."""
    with ThreadPoolExecutor(2) as pool:
        answers = list(pool.map(lambda _: lab.try_command(planned, "start"), BOTH))
    assert sorted(answer.status_code for answer in answers) == [200, 409]
    (loser,) = [answer for answer in answers if answer.status_code == 409]
    refusal = error(loser, 409, "stale")
    assert (refusal["value"], refusal["valid"]) == (0, 1)
    (change,) = refusal["details"]
    assert {"seq": 1, "type": "session_started", "actor": "account:admin"}.items() <= change.items()
    assert len(started(lab, planned["id"])) == 1


@pytest.mark.one_engine
def test_a_future_version_is_stale(lab: Lab, planned: Json) -> None:
    """A command with a later version than the session's is refused as stale."""
    error(lab.try_command({**planned, "version": 5}, "start"), 409, "stale")


@pytest.mark.parametrize(("kind", "words"), [("start", {}), ("note", {"text": "hello"})])
def test_a_repeated_command_changes_nothing(
    lab: Lab, planned: Json, kind: str, words: dict[str, str]
) -> None:
    """A command repeated with the same id gets the same answer and has no further effect."""
    command_id = str(uuid.uuid4())
    first = lab.command(planned, kind, command_id=command_id, **words)
    second = lab.command(planned, kind, command_id=command_id, **words)
    assert second == first
    assert len(lab.events(planned["id"])) == 1
    assert contents(lab, planned["id"], "note") == (kind == "note")


def test_simultaneous_repetitions_of_a_command_take_effect_once(lab: Lab, planned: Json) -> None:
    """Eight simultaneous requests with one command id all succeed and make one event."""
    command_id = str(uuid.uuid4())
    with ThreadPoolExecutor(8) as pool:
        answers = list(
            pool.map(lambda _: lab.try_command(planned, "start", command_id=command_id), range(8))
        )
    assert {answer.status_code for answer in answers} == {200}
    assert len(lab.events(planned["id"])) == 1


def test_a_note_is_accepted_at_any_version(lab: Lab, planned: Json) -> None:
    """A note is accepted although the session has changed since."""
    lab.command(planned, "start")
    view = lab.command(planned, "note", text="  they asked about the boxes  ")
    assert [note["text"] for note in view["notes"]] == ["they asked about the boxes"]
    assert view["notes"][0]["by"] == "account:admin"


@pytest.mark.one_engine
@pytest.mark.parametrize("kind", ["redo", "skip", "abort", "withdraw"])
@pytest.mark.parametrize("reason", [None, "", "   "])
def test_redo_skip_abort_and_withdraw_need_a_reason(
    lab: Lab, kind: str, reason: str | None
) -> None:
    """Redo, skip, abort and withdraw are refused without a reason, and nothing is stored."""
    view = lab.command(lab.join(), "start")
    refusal = error(lab.try_command(view, kind, reason=reason), 422, "invalid_input")
    assert refusal["message"] == f"{kind} needs a reason"
    assert lab.view(view["id"])["version"] == view["version"]
    assert contents(lab, view["id"], "reason") == 0


@pytest.mark.one_engine
@pytest.mark.parametrize("end", ["abort", "withdraw"])
def test_no_step_is_current_after_the_end(lab: Lab, end: str) -> None:
    """A session that ended early shows where it stopped as a step that was not done."""
    view = lab.skip_to(lab.join(), "free_roam")
    at = view["current"]["index"]
    ended = lab.command(view, end, reason="equipment")
    assert [step["status"] for step in ended["steps"][at:]] == ["pending"] * len(
        ended["steps"][at:]
    )
    assert ended["current"] is None


@pytest.mark.one_engine
def test_an_empty_note_is_refused(lab: Lab, planned: Json) -> None:
    """An empty note is refused."""
    error(lab.try_command(planned, "note", text=" "), 422, "invalid_input")


@pytest.mark.one_engine
def test_a_phase_without_headset_is_refused_with_a_remedy(lab: Lab) -> None:
    """Starting a phase without a headset is refused with the advice to pair or wake one."""
    view = lab.skip_to(lab.join(), "free_roam")
    refusal = error(lab.try_command(view, "begin_phase"), 409, "not_now")
    assert refusal["value"] == "headset not connected"
    assert "Pair or wake the headset" in refusal["remedy"]


@pytest.mark.one_engine
def test_entering_the_body_without_headset_is_refused(lab: Lab) -> None:
    """Entering the body is refused without a headset and accepted with one."""
    view = lab.skip_to(lab.join(), "materialise")
    refusal = error(lab.try_command(view, "materialise"), 409, "not_now")
    assert refusal["value"] == "headset not connected"
    lab.context.hub.headset_joined(view["id"])
    assert lab.command(view, "materialise")["steps"][view["current"]["index"]]["status"] == "done"


def test_a_refused_command_stores_no_reason(lab: Lab, planned: Json) -> None:
    """The reason of a refused command is not stored."""
    error(lab.try_command(planned, "skip", reason="too early"), 409, "not_now")
    assert contents(lab, planned["id"], "reason") == 0


@pytest.mark.one_engine
def test_a_second_pause_request_stores_no_second_reason(lab: Lab) -> None:
    """Requesting a pause that is already requested stores no second reason."""
    view = lab.skip_to(lab.join(), "free_roam")
    lab.context.hub.headset_joined(view["id"])
    lab.command(view, "begin_phase")
    _report_started(lab, view["id"])
    before = contents(lab, view["id"], "reason")
    for reason in ("dizzy", "still dizzy"):
        view = lab.command(lab.view(view["id"]), "pause", reason=reason)
    assert contents(lab, view["id"], "reason") == before + 1


@pytest.mark.one_engine
def test_the_view_lists_the_allowed_commands(lab: Lab, planned: Json) -> None:
    """A session's view lists the commands that are allowed now, the usual next one first."""
    assert planned["allowed"] == ["start", "note"]
    view = lab.command(planned, "start")
    assert view["allowed"][0] == "complete_step"
    view = lab.command(view, "abort", reason="fire alarm")
    assert (view["allowed"], view["status"]) == (["note"], "aborted")


def test_a_session_that_ended_early_says_why(lab: Lab, planned: Json) -> None:
    """Its view and the study's list of sessions show the reason, which no other session has."""
    view = lab.command(lab.command(planned, "start"), "abort", reason="fire alarm")
    other = lab.command(lab.join(), "start")
    listed = ok(lab.operator.get(f"/api/studies/{STUDY}/sessions"))
    of = {one["id"]: one["end_reason"] for one in listed}
    assert view["end_reason"] == of[view["id"]] == "fire alarm"
    assert other["end_reason"] is of[other["id"]] is None


@pytest.mark.one_engine
def test_a_reason_is_shown_at_its_step(lab: Lab, planned: Json) -> None:
    """A skipped step is shown with its reason."""
    view = lab.command(lab.command(planned, "start"), "skip", reason="consent on paper")
    assert (view["steps"][0]["status"], view["steps"][0]["reason"]) == (
        "skipped",
        "consent on paper",
    )


@pytest.mark.one_engine
def test_an_unknown_session_is_not_found(lab: Lab, planned: Json) -> None:
    """A command to an unknown session is answered with 404."""
    error(lab.try_command({**planned, "id": "nobody"}, "start"), 404, "not_found")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "fields",
    [
        {"type": "explode"},
        {"command_id": "short"},
        {"expected_version": -1},
        {"expected_version": 2**70},
        {"step_index": 2**70},
        {"surprise": 1},
        {"height_m": {"stated": 17.5}},
        {"reason": "x" * 2001},
    ],
)
def test_an_invalid_command_is_refused_by_field(
    lab: Lab, planned: Json, fields: dict[str, Any]
) -> None:
    """An invalid command is refused with 422 and the name of the field."""
    body = {"command_id": str(uuid.uuid4()), "expected_version": 0, "type": "start", **fields}
    answer = lab.operator.post(f"/api/sessions/{planned['id']}/commands", json=body)
    refusal = error(answer, 422, "invalid_input")
    assert any(next(iter(fields)) in detail["path"] for detail in refusal["details"])


def test_a_change_is_published_only_after_its_commit(
    lab: Lab, planned: Json, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A change is published only after its transaction commits, not at an inner savepoint."""
    heard: list[str] = []
    with lab.database.writing() as db:
        session = db.get_one(StudySession, planned["id"])
        with db.begin_nested():
            session.language = "de"
            monkeypatch.setattr(
                lab.context.hub, "publish", lambda *_: heard.append(_stored(lab, planned["id"]))
            )
            lab.context.hub.publish_after_commit(db, planned["id"])
        assert heard == []
    assert heard == ["de"]


def test_nothing_is_published_when_the_transaction_fails(
    lab: Lab, planned: Json, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is published when the transaction is rolled back."""
    heard: list[str] = []
    monkeypatch.setattr(lab.context.hub, "publish", lambda *_: heard.append("news"))
    with lab.database._writer() as db:
        lab.context.hub.publish_after_commit(db, planned["id"])
        db.rollback()
    assert heard == []


@pytest.mark.one_engine
def test_a_blinded_operator_sees_no_latency_anywhere(fresh_lab: Lab) -> None:
    """A blinded operator sees no latency or order in session, events, ledger or figures."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    ok(fresh_lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
    view = fresh_lab.skip_to(fresh_lab.join(), "block1.hand")
    fresh_lab.context.hub.headset_joined(view["id"])
    view = fresh_lab.command(view, "begin_phase")
    assert view["sequence"] is None
    assert {step["latency_ms"] for step in view["steps"]} == {None}
    assert {phase["latency_ms"] for phase in view["phases"]} == {None}
    assert not any("latency_ms" in event["data"] for event in fresh_lab.events(view["id"]))
    ledger = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/ledger"))
    assert ledger["sequences"] is None
    assert {slot["sequence"] for slot in ledger["slots"]} == {None}
    receipt = ok(fresh_lab.operator.get(f"/api/sessions/{view['id']}/receipt"))
    assert receipt["achieved_latency"] == []
    blind_to = {"joint_error_deg": {"Head": 5.0}, "side_contacts": 3, "client_t_s": 12.5}
    figures = {"fps": 90.0, "completions": 4, **blind_to}
    made = {**figures, "completions_on_beat": 2}
    assert live_figures(made, blinded=True) == {"fps": 90.0, "completions": 2}
    assert live_figures(made, blinded=False) == figures
    assert live_figures({"figure_of_tomorrow": 1.0}, blinded=True) == {}
    signal = {"gaps": 1, "frames_flagged": 7, "frames_flagged_of_participant": 2}
    for is_blind, flagged in ((True, 2), (False, 7)):
        told = live_figures({"signal": signal}, blinded=is_blind)
        assert told == {"signal": {"gaps": 1, "frames_flagged": flagged}}
        assert live_figures({"signal": None}, blinded=is_blind) == {"signal": None}


def _stored(lab: Lab, session_id: str) -> str:
    with lab.database.reading() as db:
        return db.get_one(StudySession, session_id).language


def _report_started(lab: Lab, session_id: str) -> None:
    with lab.database.writing() as db:
        session = session_by_id(db, session_id, lock=True)
        report = Report(what="started", phase_id=1, client_t_s=1.0, active_s=0.0)
        apply_command(db, lab.context, session, report, actor="headset")


def test_only_a_running_session_says_at_which_step_it_is(lab: Lab) -> None:
    """A planned session has no step in the list; a started one has the first, of how many."""
    running, planned = lab.join(), lab.join()
    started = lab.command(running, "start")
    listed = {one["id"]: one for one in ok(lab.operator.get(f"/api/studies/{STUDY}/sessions"))}
    assert listed[planned["id"]]["step"] is None
    assert listed[running["id"]]["step"] == {
        "index": 0,
        "steps": len(started["steps"]),
        "kind": "consent",
        "limb": None,
        "paused": False,
    }
