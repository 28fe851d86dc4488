"""Tests of what is refused: by whom, what and how much; and what the refusal says."""

from typing import Any

import pytest

from app.features.movement.jobs import MOST_AT_ONCE
from app.models import AvatarTuningRow, new_id
from app.protocol.avatar import loaded
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.tuning.tunings import ARM, PATH, as_json, begun, settled

pytestmark = pytest.mark.one_engine

ELBOW = "LeftLowerArmY"


def refused(lab: Lab, status: int, code: str, **request: Any) -> Json:
    """Order a tuning that is refused, and return the error."""
    found: Json = error(lab.operator.post(PATH, json=request), status, code)
    assert found["remedy"]
    return found


def test_a_wrong_order_is_refused_with_value_and_what_is_valid(lab: Lab) -> None:
    """Unknown axes, numbers out of range and unknown versions are refused, each with its value."""
    arm = {"configuration": as_json(ARM)}
    unknown = refused(lab, 422, "invalid_input", **arm, options={"axes": [ELBOW, "Elbow"]})
    assert (unknown["value"], ELBOW in unknown["valid"]) == (["Elbow"], True)
    torque = {"relay_torques_nm": {"Elbow": 2.0}}
    assert refused(lab, 422, "invalid_input", **arm, options=torque)["value"] == ["Elbow"]
    held = refused(lab, 422, "invalid_input", **arm, options={"axes": ["SpineX"]})
    assert (held["value"], len(held["valid"])) == (["SpineX"], 8)
    for option, value, least_or_most in [
        ("longest_s", 0.001, "0.01"),
        ("longest_s", 601.0, "600"),
        ("longest_wall_s", 601.0, "600"),
        ("attempts", 0, "1"),
    ]:
        (detail,) = refused(lab, 422, "invalid_input", **arm, options={option: value})["details"]
        assert detail["path"].endswith(option)
        assert detail["value"] == value
        assert least_or_most in detail["message"]
    new = {"key": "one", "title": "One", "origin": "by_hand"} | arm
    ok(lab.operator.post("/api/avatars", json=new))
    missing = refused(lab, 404, "not_found", avatar={"key": "one", "version": 7})
    assert (missing["value"], missing["valid"]) == (7, "1 to 1")
    assert refused(lab, 404, "not_found", avatar={"key": "nobody"})["value"] == "nobody"
    both = arm | {"avatar": {"key": "one"}}
    assert "either" in refused(lab, 422, "invalid_input", **both)["details"][0]["message"]


def test_too_many_tunings_at_once_are_refused(fresh_lab: Lab) -> None:
    """When as many tunings wait as may, another is neither ordered nor resumed; one less may be."""
    content, lab = loaded(ARM), fresh_lab
    options = {"axes": [ELBOW]}
    ids = [new_id() for _ in range(MOST_AT_ONCE + 1)]
    with lab.database.writing() as db:
        for tuning_id in ids:
            row = AvatarTuningRow(
                id=tuning_id,
                content_hash=content.content_hash,
                canonical_json=content.canonical_json,
                stature_m=1.75,
                options=options,
                state="stopped" if tuning_id == ids[-1] else "tuning",
                by="account:admin",
                at=lab.context.clock.utc_now(),
            )
            db.add(row)
    order = {"configuration": as_json(ARM), "options": options}
    full = refused(lab, 503, "busy", **order)
    assert (full["value"], full["valid"]) == (MOST_AT_ONCE, f"up to {MOST_AT_ONCE} at once")
    error(lab.operator.post(f"{PATH}/{ids[-1]}/resume"), 503, "busy")
    assert len(ok(lab.operator.get(PATH))) == MOST_AT_ONCE + 1
    ok(lab.operator.post(f"{PATH}/{ids[0]}/stop"))
    started = ok(lab.operator.post(PATH, json=order))
    assert settled(lab, started["id"])["state"] == "ready"


def test_only_designers_tune(lab: Lab) -> None:
    """An operator, who may be blinded, and an analyst see a tuning but cannot order or change it.

    Nothing that they are told names a study, a condition or a latency.
    """
    tuning = settled(lab, begun(lab, axes=[ELBOW])["id"])
    path = f"{PATH}/{tuning['id']}"
    order = {"configuration": as_json(ARM), "options": {"axes": [ELBOW]}}
    save = {"accepted": [ELBOW], "key": "mine", "title": "Mine"}
    for role in ("operator", "analyst"):
        person = sign_in(lab, role)
        seen = person.get(path)
        assert ok(seen)["state"] == "ready"
        assert not {"study", "condition", "latency_ms"} & set(seen.json())
        assert ok(person.post(f"{path}/configuration", json={"accepted": [ELBOW]}))["changed"]
        for refusal in (
            person.post(PATH, json=order),
            person.post(f"{path}/stop"),
            person.post(f"{path}/resume"),
            person.post(f"{path}/save", json=save),
            person.delete(path),
        ):
            told = error(refusal, 403, "not_allowed")
            assert (told["value"], told["valid"]) == (role, ["admin", "experimenter"])
            assert told["remedy"]


def test_two_people_see_each_others_doing(lab: Lab) -> None:
    """Who stops or looks at what a colleague has ended or discarded is told so, and what to do."""
    tuning = begun(lab, axes=[ELBOW])
    path = f"{PATH}/{tuning['id']}"
    colleague = sign_in(lab, "experimenter")
    listed = {one["id"]: one for one in ok(colleague.get(PATH))}
    assert listed[tuning["id"]]["by"] == tuning["by"]
    settled(lab, tuning["id"])
    late = error(colleague.post(f"{path}/stop"), 409, "not_now")
    assert (late["value"], late["valid"]) == ("ready", ["tuning"])
    assert "somebody else" in late["remedy"]
    ok(colleague.delete(path))
    gone = error(lab.operator.get(path), 404, "not_found")
    assert gone["value"] == tuning["id"]
    assert "deleted" in gone["remedy"]
