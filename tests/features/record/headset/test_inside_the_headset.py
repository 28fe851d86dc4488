"""Tests of what a headset reports of the participant's body, and of calls from inside it."""

from sqlalchemy import select

from app.models import AlarmRow, ClientReport, Phase
from tests.features.lab import Json, error, ok
from tests.features.record.headset.site import Headset, Site
from tests.wire.message_vectors import ADDED_LATENCY, CALIBRATION, GOALS

ABLE = {"goals": True, "panels": True, "calibrates": True}
MEASURED: Json = {**GOALS, "states": dict.fromkeys(GOALS["states"], "tracked")}


def feet(site: Site, session_id: str) -> Json:
    """Return the pre-flight check of the feet."""
    checks = ok(site.operator.get(f"/api/sessions/{session_id}/preflight"))["checks"]
    return next(check for check in checks if check["key"] == "feet")


def codes(site: Site, session_id: str) -> list[str]:
    """Return the codes of the session's open alarms."""
    return [alarm["code"] for alarm in site.view(session_id)["alarms"]]


def running(site: Site, session_id: str, headset: Headset) -> int:
    """Run the current phase and return its id."""
    site.command(session_id, "begin_phase")
    state = headset.hear("state", lambda state: state["phase"] is not None)
    phase_id = int(state["phase"]["phase_id"])
    headset.reported(kind="phase", phase_id=phase_id, what="started", t_s=1.0, active_s=0.0)
    return phase_id


def refused(site: Site, session_id: str, kind: str) -> Json:
    """Send a command that must be refused, and return its error."""
    body = {
        "command_id": f"refused-{session_id[:20]}",
        "expected_version": site.view(session_id)["version"],
        "type": kind,
    }
    return error(
        site.operator.post(f"/api/sessions/{session_id}/commands", json=body), 409, "not_now"
    )


def test_a_foot_task_needs_measured_feet(site: Site) -> None:
    """Feet that are inferred fail their check and refuse the foot task; measured ones allow it."""
    session_id = site.join()
    site.skip_to(session_id, "block1.foot")
    with site.headset(site.token(session_id), **ABLE) as headset:
        panel = headset.welcome["state"]["panel"]
        assert (panel["limb"], set(panel["screen_texts"])) == ("foot", {"freeze", "walk_back"})
        assert feet(site, session_id)["code"] == "feet.waiting"
        headset.reported(**GOALS)
        assert (feet(site, session_id)["code"], feet(site, session_id)["status"]) == (
            "feet.inferred",
            "fail",
        )
        assert site.view(session_id)["goals"]["states"]["LeftLowerLeg"] == "inferred"
        assert "does not measure" in refused(site, session_id, "begin_phase")["message"]
        headset.reported(**MEASURED)
        assert feet(site, session_id)["status"] == "ok"
        site.command(session_id, "begin_phase")


def test_a_foot_task_without_measured_feet_needs_a_reason(site: Site) -> None:
    """Somebody who overrides the check of the feet, with a reason, may begin the foot task."""
    session_id = site.join()
    site.skip_to(session_id, "block1.foot")
    with site.headset(site.token(session_id), **ABLE) as headset:
        headset.reported(**GOALS)
        path = f"/api/sessions/{session_id}/preflight/overrides"
        ok(site.operator.post(path, json={"check": "feet", "reason": "a try-out"}))
        site.command(session_id, "begin_phase")


def test_feet_that_are_lost_in_a_foot_task_raise_an_alarm(quick_site: Site) -> None:
    """An alarm is open while a foot that acts is not measured."""
    site, session_id = quick_site, quick_site.join()
    site.skip_to(session_id, "block1.foot")
    with site.headset(site.token(session_id), **ABLE) as headset:
        headset.reported(**MEASURED)
        running(site, session_id, headset)
        lost = {**MEASURED["states"], "LeftLowerLeg": "lost"}
        headset.reported(**{**MEASURED, "frame_seq": 90, "t_s": 10.5, "states": lost})
        headset.hear("state", lambda _: "feet_untracked" in codes(site, session_id))


def test_a_headset_that_says_nothing_of_its_goals_is_served_as_before(site: Site) -> None:
    """A client of an earlier release gets no new field, and may run the foot task."""
    session_id = site.join()
    site.skip_to(session_id, "block1.foot")
    with site.headset(site.token(session_id)) as headset:
        assert not {"panel", "calibration"} & headset.welcome["state"].keys()
        assert feet(site, session_id)["code"] == "feet.unknown"
        site.command(session_id, "begin_phase")
        assert "calibrates: false" in str(refused(site, session_id, "calibrate"))


def test_the_operator_orders_a_calibration_and_shifts_trackers(site: Site) -> None:
    """A calibration in mid-phase pauses it and keeps the step; its report ends order and shifts."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    with site.headset(site.token(session_id), **ABLE) as headset:
        headset.reported(**CALIBRATION)
        first = site.view(session_id)["calibration"]
        assert (first["stature_m"], first["residuals_cm"]["LeftHand"]) == (1.72, 1.2)
        running(site, session_id, headset)
        step = site.view(session_id)["current"]["index"]
        shift = {"goal": "LeftHand", "right_cm": 1.0, "up_cm": 0.0, "back_cm": -2.5}
        view = site.command(session_id, "shift_tracker", tracker_shift=shift)
        assert view["calibration"]["shifts_cm"] == {"LeftHand": [1.0, 0.0, -2.5]}
        state = headset.hear("state", lambda state: "calibration" in state)
        assert state["calibration"]["shifts_m"] == {"LeftHand": [0.01, 0.0, -0.025]}
        site.command(session_id, "calibrate", reason="the strap slipped")
        wanted = headset.hear("state", lambda state: state["calibration"]["calibrate"])
        assert wanted["phase"]["pausing"]
        revision = wanted["calibration"]["revision"]
        headset.reported(**{**CALIBRATION, "cause": "order", "revision": revision, "t_s": 12.0})
        view = site.view(session_id)
    assert view["current"]["index"] == step
    assert (view["calibration"]["cause"], view["calibration"]["wanted"]) == ("order", False)
    assert view["calibration"]["shifts_cm"] == {}
    events = ok(site.operator.get(f"/api/sessions/{session_id}/events"))
    kinds = [event["type"] for event in events]
    assert kinds.count("calibration_reported") == 2
    assert {"tracker_shifted", "calibration_requested"} <= set(kinds)
    assert "1.72" not in str([e["data"] for e in events if e["type"] == "calibration_reported"])


def test_a_calibration_that_nobody_ordered_is_refused_as_an_answer(site: Site) -> None:
    """A calibration that answers an unknown order is stored as refused and used nowhere."""
    session_id = site.join()
    with site.headset(site.token(session_id), **ABLE) as headset:
        headset.report(**{**CALIBRATION, "revision": 900})
        assert "no calibration was ordered" in headset.hear("refused")["message"]
    assert site.view(session_id)["calibration"] is None


def test_a_call_to_stop_pauses_the_phase_and_alarms(site: Site) -> None:
    """A participant's stop pauses the phase and alarms the operator until the phase is resumed."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    with site.headset(site.token(session_id), **ABLE) as headset:
        phase_id = running(site, session_id, headset)
        headset.reported(kind="call", t_s=2.0, what="stop")
        state = headset.hear("state", lambda state: state["panel"]["called"])
        assert state["phase"]["pausing"]
        assert codes(site, session_id) == ["stop_asked"]
        headset.reported(kind="phase", phase_id=phase_id, what="paused", t_s=2.1, active_s=1.1)
        site.command(session_id, "resume")
        assert codes(site, session_id) == []
        headset.reported(kind="call", t_s=3.0, what="help")
        assert codes(site, session_id) == ["help_asked"]
        headset.reported(kind="call", t_s=4.0, what="taken_back")
        assert codes(site, session_id) == []
        headset.reported(kind="call", t_s=5.0, what="stop")
        ok(site.operator.post(f"/api/sessions/{session_id}/help/answered"))
        assert codes(site, session_id) == []


def test_added_latency_belongs_to_a_phase(site: Site) -> None:
    """What computing adds is stored for its phase, and refused for a phase that does not exist."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    with site.headset(site.token(session_id), **ABLE) as headset:
        phase_id = running(site, session_id, headset)
        headset.reported(**{**ADDED_LATENCY, "phase_id": phase_id})
        headset.report(**{**ADDED_LATENCY, "phase_id": 77})
        assert "no phase 77" in headset.hear("refused")["message"]
    with site.database.reading() as db:
        own = ClientReport.session_id == session_id
        rows = list(db.scalars(select(ClientReport).where(own).order_by(ClientReport.seq)))
        assert db.get(Phase, (session_id, phase_id)) is not None
    assert [row.accepted for row in rows if row.type == "added_latency"] == [True, False]


def refusals(site: Site, session_id: str) -> list[str]:
    """Return why the session's reports were refused, in their order."""
    own = (ClientReport.session_id == session_id, ~ClientReport.accepted)
    with site.database.reading() as db:
        return list(map(str, db.scalars(select(ClientReport.refusal).where(*own).order_by("seq"))))


def test_a_calibration_that_measured_nobody_is_refused(site: Site) -> None:
    """Lengths of nobody, and what is no rotation, are stored as refused and shown nowhere."""
    session_id = site.join()
    pose = {"position_m": [0.0, 0.1, 0.0], "rotation": [0.0, 0.0, 0.0, 0.0]}
    far = {"position_m": [9.0, 9.0, 9.0], "rotation": [1.0, 0.0, 0.0, 0.0]}
    impossible: list[Json] = [
        {"span_m": 9.0},
        {"eye_height_m": 0.0},
        {"tracker_from_goal": {"Head": pose}},
        {"eye_height_m": 2.5},
        {"eye_height_m": 0.4},
        {"segments_m": {"nose": 1.0}},
        {"segments_m": {"thigh": 9.0}},
        {"segments_m": {"upper_arm": 0.0}},
        {"residuals_m": {"Head": 9.0}},
        {"tracker_from_goal": {"Head": far}},
    ]
    with site.headset(site.token(session_id), **ABLE) as headset:
        for one in impossible:
            headset.reported(**{**CALIBRATION, **one})
        assert site.view(session_id)["calibration"] is None
        headset.reported(**{**CALIBRATION, "stature_m": 0.5, "eye_height_m": 0.46})
    assert [one.split()[0].partition(".")[0] for one in refusals(site, session_id)] == [
        *(
            "span_m",
            "eye_height_m",
            "tracker_from_goal",
            "eyes",
            "eyes",
            "segments_m",
            "segments_m",
        ),
        *("segments_m", "residuals_m", "tracker_from_goal"),
    ]
    assert site.view(session_id)["calibration"]["stature_m"] == 0.5


def test_reports_that_contradict_order_or_run_are_refused(site: Site) -> None:
    """What cannot be taken off the ordered delay, and goals of frames out of order, are refused.

    One that was refused spoils nothing: the next goals of the run are taken.
    """
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    with site.headset(site.token(session_id), **ABLE) as headset:
        phase_id = running(site, session_id, headset)
        taken_off = {"phase_id": phase_id, "added_s": 0.5, "compensated_s": 0.5}
        headset.reported(**{**ADDED_LATENCY, **taken_off})
        for frame_seq in (2**52, 90, 10, 90, 91):
            headset.reported(**{**GOALS, "frame_seq": frame_seq})
    delay, ahead, back = refusals(site, session_id)
    assert "cannot be taken off the 0 ms" in delay
    assert "frames in" in ahead
    assert "from frame 90 on are reported already" in back


def test_calls_that_are_taken_back_again_and_again_stay_open(site: Site) -> None:
    """A hundred calls in a moment make a few alarms; the last call stays open until somebody comes.

    No call is refused, and afterwards the participant can call again.
    """
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    with site.headset(site.token(session_id), **ABLE) as headset:
        for _ in range(33):
            for what in ("stop", "help", "taken_back"):
                headset.report(kind="call", t_s=2.0, what=what)
        headset.acknowledged("reports", headset.next_report)
        assert sorted(codes(site, session_id)) == ["help_asked", "stop_asked"]
        with site.database.reading() as db:
            rows = select(AlarmRow).where(AlarmRow.session_id == session_id)
            raised = [row.code for row in db.scalars(rows) if row.state == "raised"]
        assert len(raised) <= 6
        assert {one.split(",")[0] for one in refusals(site, session_id)} == {
            "the participant called several times within a minute"
        }
        ok(site.operator.post(f"/api/sessions/{session_id}/help/answered"))
        assert codes(site, session_id) == []
        headset.reported(kind="call", t_s=5.0, what="stop")
        assert codes(site, session_id) == ["stop_asked"]
