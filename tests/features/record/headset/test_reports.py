"""Tests of what a headset's reports change, and that each takes effect once."""

import time

import pytest
from sqlalchemy import select

from app.models import ClientReport, Completion, Contact, JointErrorRow, Phase, StudySession
from app.wire import BODY_STREAMS
from tests.features.lab import STUDY, Json, ok
from tests.features.record.headset.site import Headset, Site
from tests.wire.samples import CONTACT_REPORT, message, standing

COMPLETION: Json = {
    "kind": "completion",
    "number": 1,
    "t_s": 2.0,
    "active_s": 2.0,
    "duration_s": 2.0,
    "order": [4, 3, 2, 1],
    "out_of_order_touches": 0,
}


def running(site: Site) -> tuple[str, str]:
    """Return a session whose free movement can be started, and its headset's token."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    return session_id, site.token(session_id)


def begin(site: Site, session_id: str, headset: Headset) -> int:
    """Start the phase, let the headset start its clock, and return the phase's id."""
    site.command(session_id, "begin_phase")
    state = headset.hear("state", lambda state: state["phase"] is not None)
    phase_id = int(state["phase"]["phase_id"])
    headset.reported(kind="phase", phase_id=phase_id, what="started", t_s=1.0, active_s=0.0)
    return phase_id


def test_an_invalid_report_is_stored_as_refused(site: Site) -> None:
    """A report that does not fit the session is stored with its refusal and changes nothing."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        headset.report(kind="phase", phase_id=1, what="ended", t_s=1.0, active_s=0.0)
        refused = headset.hear("refused")
    assert "phase 1 is not in progress" in refused["message"]
    with site.database.reading() as db:
        (row,) = db.scalars(select(ClientReport).where(ClientReport.session_id == session_id))
    assert (row.accepted, row.refusal) == (False, refused["message"])
    assert row.payload["what"] == "ended"
    assert site.view(session_id)["current"]["status"] == "ready"


def test_contacts_and_completions_of_a_phase_are_counted(site: Site) -> None:
    """Contacts and completed tasks are counted in their phase in the cockpit."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        headset.reported(**CONTACT_REPORT, phase_id=phase_id)
        headset.reported(**COMPLETION, phase_id=phase_id)
    (phase,) = site.view(session_id)["phases"]
    assert (phase["side_contacts"], phase["side_contact_s"]) == (1, 1.0)
    assert phase["completions"] == 1


@pytest.mark.one_engine
def test_a_blinded_reader_gets_no_count_that_rises_while_a_phase_runs(site: Site) -> None:
    """A count that rises tells when the avatar arrived, so it is hidden until the phase has ended.

    Neither the cockpit's view nor the size of the stream of reports tells it, nor the receipt.
    """
    yaml = ok(site.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    blinded = blinded.replace(f"key: {STUDY}", "key: blinded-counts", 1)
    ok(site.operator.post("/api/studies", json={"yaml": blinded}))
    made = site.operator.post("/api/studies/blinded-counts/sessions", json={})
    session_id = str(ok(made)["id"])
    site.skip_to(session_id, "free_roam")
    token = site.token(session_id)
    counts = ("completions", "side_contacts", "side_contact_s")

    def seen() -> tuple[Json, set[str]]:
        stored = ok(site.operator.get(f"/api/sessions/{session_id}/streams"))
        receipt = ok(site.operator.get(f"/api/sessions/{session_id}/receipt"))
        told = [one for one in receipt["problems"] if "reports" in one]
        names = {one["stream"] for one in (*stored, *receipt["streams"])}
        return site.view(session_id)["phases"][0], names.union(told)

    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        headset.reported(**CONTACT_REPORT, phase_id=phase_id)
        headset.reported(**COMPLETION, phase_id=phase_id)
        view = site.view(session_id)
        duration_s = view["steps"][view["current"]["index"]]["duration_s"]
        phase, streams = seen()
        assert [phase[name] for name in counts] == [None, None, None]
        assert "reports" not in streams
        headset.reported(
            kind="phase", phase_id=phase_id, what="time_up", t_s=131.0, active_s=duration_s
        )
        headset.reported(
            kind="phase", phase_id=phase_id, what="ended", t_s=136.0, active_s=duration_s
        )
    phase, streams = seen()
    assert [phase[name] for name in counts] == [1, 1, 1.0]
    assert "reports" in streams


@pytest.mark.one_engine
@pytest.mark.parametrize("body", [CONTACT_REPORT, COMPLETION])
def test_reports_of_an_unknown_phase_are_refused(site: Site, body: Json) -> None:
    """A contact or completed task of an unknown phase is refused and not counted."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.report(**body, phase_id=7)
        assert headset.hear("refused")["message"] == "there is no phase 7"
    with site.database.reading() as db:
        assert not list(db.scalars(select(Contact).where(Contact.session_id == session_id)))
        assert not list(db.scalars(select(Completion).where(Completion.session_id == session_id)))


def test_a_completion_reported_twice_counts_once(site: Site) -> None:
    """A second completed task with the same number is refused."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        headset.reported(**COMPLETION, phase_id=phase_id)
        headset.report(**{**COMPLETION, "duration_s": 9.0}, phase_id=phase_id)
        assert "was reported before" in headset.hear("refused")["message"]
        headset.reported(**{**COMPLETION, "number": 2}, phase_id=phase_id)
    assert site.view(session_id)["phases"][0]["completions"] == 2


def test_a_resent_report_is_acknowledged_without_effect(site: Site) -> None:
    """A report resent with the same seq is acknowledged and has no further effect."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        headset.reported(**CONTACT_REPORT, phase_id=phase_id)
        headset.next_report -= 1
        headset.reported(**CONTACT_REPORT, phase_id=phase_id)
    assert site.view(session_id)["phases"][0]["side_contacts"] == 1


@pytest.mark.one_engine
def test_losing_the_headset_pauses_at_the_last_time_on_disk(site: Site) -> None:
    """Losing the headset pauses the phase at the last active time that is on disk."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        headset.say(message(standing(9), phase_id=phase_id, active=True, active_s=3.25))
        headset.acknowledged("target", 9)
    with site.headset(token) as headset:
        state = headset.welcome["state"]
        if state["phase"]["status"] != "paused":
            state = headset.hear("state", lambda state: state["phase"]["status"] == "paused")
    assert state["phase"]["active_s"] == 3.25
    assert site.view(session_id)["current"]["pause_reason"] == "headset_lost"


def test_a_whole_phase_ends_with_its_joint_errors(site: Site) -> None:
    """A completed phase counts, and its joint errors are computed."""

    session_id, token = running(site)
    with site.headset(token) as headset:
        phase_id = begin(site, session_id, headset)
        for stream in BODY_STREAMS:
            headset.say(
                message(standing(90), stream=stream, phase_id=phase_id, active=True, active_s=120)
            )
        for what in ("time_up", "ended"):
            headset.reported(kind="phase", phase_id=phase_id, what=what, t_s=2.0, active_s=120.0)
    with site.database.reading() as db:
        session = db.get_one(StudySession, session_id)
        phase = db.get_one(Phase, (session_id, phase_id))
    assert (phase.status, phase.active_s, session.status) == ("done", 120.0, "active")
    errors = joint_errors(site, session_id)
    deadline_s = time.monotonic() + 20.0
    while not errors and time.monotonic() < deadline_s:
        time.sleep(0.05)
        errors = joint_errors(site, session_id)
    assert {error.samples for error in errors} == {90}
    assert {error.mean_rad for error in errors if error.reference == "present"} == {0.0}


def joint_errors(site: Site, session_id: str) -> list[JointErrorRow]:
    """Return the joint error rows of a session."""
    with site.database.reading() as db:
        query = select(JointErrorRow).where(JointErrorRow.session_id == session_id)
        return list(db.scalars(query))
