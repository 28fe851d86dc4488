"""Tests of a tuning over HTTP: its result, curves, comparison, acceptance and versions."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli.installation import opened_database
from app.clock import Clock
from app.features.movement.avatar import NewAvatar, create_avatar
from app.protocol.avatar import file_of, load_avatar
from tests.cli.invoked import Invoked
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.tuning.tunings import ARM, PATH, as_json, begun, settled

ELBOW = "LeftLowerArmY"
TUNED = ("tuned", "retried", "flagged")


@pytest.fixture(scope="module")
def tuned(lab: Lab) -> Json:
    """Return a finished tuning of a stored avatar of which only the left arm is free."""
    new = {"key": "arm", "title": "Arm", "origin": "by_hand", "configuration": as_json(ARM)}
    ok(lab.operator.post("/api/avatars", json=new))
    started = ok(lab.operator.post(PATH, json={"avatar": {"key": "arm"}}))
    assert (started["state"], started["avatar"]) == ("tuning", {"key": "arm", "version": 1})
    return settled(lab, started["id"])


def test_a_tuning_gives_what_the_command_gives(
    tuned: Json, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tuning on the server and `reembody tune` give the same gains, to the last bit."""
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    (tmp_path / "data").mkdir()
    request = NewAvatar(key="arm", title="Arm", origin="by_hand", configuration=file_of(ARM))
    with opened_database("test") as database, database.writing() as db:
        create_avatar(db, "tester", request, Clock().utc_now())
    figures = Invoked("tune").figures("--avatar", "arm", "--out", tmp_path / "out.json")
    assert tuned["report"]["axes"] == figures["axes"]
    written = load_avatar((tmp_path / "out.json").read_text()).configuration
    for one in tuned["tuned"]:
        assert (one["kp"], one["kd"]) == (
            written.axes[one["name"]].kp,
            written.axes[one["name"]].kd,
        )
        assert (one["kp_before"], one["kd_before"]) == (
            ARM.axes[one["name"]].kp,
            ARM.axes[one["name"]].kd,
        )
    assert sum(one["status"] in TUNED for one in tuned["tuned"]) == 8
    assert sum(one["status"] == "locked" for one in tuned["tuned"]) == 83
    assert (tuned["state"], tuned["progress"], tuned["trouble"]) == ("ready", None, None)


@pytest.mark.one_engine
def test_the_curves_of_an_axis_show_its_figures(lab: Lab, tuned: Json) -> None:
    """The relay's curve swings by its measured amplitude, the step's comes to rest as reported."""
    figures = next(one for one in tuned["tuned"] if one["name"] == ELBOW)
    curves = ok(lab.operator.get(f"{PATH}/{tuned['id']}/axes/{ELBOW}"))
    relay, after, before = curves["relay"], curves["after"], curves["before"]
    last = np.array(relay["angle_deg"])[np.array(relay["time_s"]) > 0.75 * relay["time_s"][-1]]
    assert np.ptp(last) / 2.0 == pytest.approx(figures["relay"]["amplitude_deg"], rel=0.02)
    assert relay["time_s"][-1] == pytest.approx(figures["relay"]["simulated_s"], abs=0.01)
    assert max(relay["torque_nm"]) == pytest.approx(figures["relay"]["torque_nm"], abs=1e-5)
    rest = np.mean(after["angle_deg"][-25:])
    assert after["target_deg"] - rest == pytest.approx(
        figures["step"]["steady_error_deg"], abs=0.01
    )
    assert after["angle_deg"] != before["angle_deg"]
    assert after["target_deg"] == before["target_deg"]
    limit = ARM.axes[ELBOW].max_torque_nm
    assert max(map(abs, after["torque_nm"])) <= limit
    assert 0.0 <= after["saturated_share"] <= 1.0
    refusal = error(lab.operator.get(f"{PATH}/{tuned['id']}/axes/SpineX"), 422, "invalid_input")
    assert ELBOW in refusal["valid"]


def test_accepted_axes_are_saved_with_the_report(lab: Lab, tuned: Json) -> None:
    """Only accepted axes change, and the version that is saved keeps the tuning's report."""
    path = f"{PATH}/{tuned['id']}"
    found = ok(lab.operator.post(f"{path}/configuration", json={"accepted": [ELBOW]}))
    assert {one["axis"] for one in found["changed"]} == {ELBOW}
    nothing = ok(lab.operator.post(f"{path}/configuration", json={"accepted": []}))
    assert (nothing["changed"], nothing["content_hash"]) == ([], tuned["content_hash"])
    refused = lab.operator.post(f"{path}/configuration", json={"accepted": ["SpineX"]})
    assert ELBOW in error(refused, 422, "invalid_input")["valid"]
    request = {"accepted": [ELBOW], "key": "arm", "based_on": 1}
    saved = ok(lab.operator.post(f"{path}/save", json=request))["newest"]
    assert (saved["number"], saved["origin"]) == (2, "tuned")
    assert saved["content_hash"] == found["content_hash"]
    assert saved["report"]["accepted"] == [ELBOW]
    assert saved["report"]["axes"] == tuned["report"]["axes"]
    assert saved["note"].startswith(
        "tuned by critical on a body of 1.75 m, 1 of 8 axes accepted; relay"
    )
    stale = lab.operator.post(f"{path}/save", json=request | {"accepted": ["LeftHandX"]})
    error(stale, 409, "stale")
    empty = lab.operator.post(f"{path}/save", json=request | {"accepted": []})
    assert ELBOW in error(empty, 422, "invalid_input")["valid"]
    assert ok(lab.operator.post(f"{path}/save", json=request))["newest"]["number"] == 2
    noted = lab.operator.post(f"{path}/save", json=request | {"note": "another"})
    assert "arm@2 has these settings already" in error(noted, 409, "conflict")["message"]
    other = {"accepted": [ELBOW], "key": "soft-arm", "title": "Soft arm", "note": "a pilot"}
    assert ok(lab.operator.post(f"{path}/save", json=other))["newest"]["note"] == "a pilot"


def test_gains_are_saved_only_onto_what_was_tuned(lab: Lab, tuned: Json) -> None:
    """A version that differs from what was tuned is refused by name, and keeps its settings."""
    heavier = as_json(replace(ARM, total_mass_kg=80.0))
    new = {"key": "heavy", "title": "Heavy", "origin": "by_hand", "configuration": heavier}
    ok(lab.operator.post("/api/avatars", json=new))
    request = {"accepted": [ELBOW], "key": "heavy", "based_on": 1}
    path = f"{PATH}/{tuned['id']}/save"
    refused = error(lab.operator.post(path, json=request), 409, "conflict")
    assert "tuned arm@1 (" in refused["message"]
    assert (refused["value"], refused["valid"]) == ("heavy@1", "arm@1")
    assert ok(lab.operator.get("/api/avatars/heavy"))["newest"]["number"] == 1
    same = new | {"key": "same", "title": "Same", "configuration": as_json(ARM)}
    ok(lab.operator.post("/api/avatars", json=same))
    saved = ok(lab.operator.post(path, json=request | {"key": "same"}))["newest"]
    assert (saved["number"], saved["origin"]) == (2, "tuned")


@pytest.mark.one_engine
def test_a_comparison_shows_the_errors_before_and_after(lab: Lab, tuned: Json) -> None:
    """With nothing accepted both sides are equal; with an axis accepted only its error differs."""
    path = f"{PATH}/{tuned['id']}/comparison"
    same = ok(lab.operator.post(path, json={"accepted": [], "longest_s": 1.5}))
    assert same["before"] == same["after"]
    assert (same["frames"], same["before"]["frames"]) == (135, 89)
    other = ok(lab.operator.post(path, json={"accepted": [ELBOW], "longest_s": 1.5}))
    assert other["before"] == same["before"]
    before, after = other["before"]["rms_error_deg"], other["after"]["rms_error_deg"]
    assert len(before) == 8
    assert before[ELBOW] != after[ELBOW]
    unknown = lab.operator.post(path, json={"accepted": [], "capture_id": "none"})
    error(unknown, 404, "not_found")


def test_chosen_axes_are_tuned_and_the_others_kept(lab: Lab) -> None:
    """Only chosen axes are tuned; what cannot be tuned is refused, or fails with a reason."""
    view = settled(lab, begun(lab, axes=[ELBOW])["id"])
    by_status = {one["name"]: one["status"] for one in view["tuned"]}
    assert by_status[ELBOW] in TUNED
    assert by_status["LeftHandX"] == "kept"
    hand = next(one for one in view["tuned"] if one["name"] == "LeftHandX")
    assert (hand["kp"], hand["kd"]) == (hand["kp_before"], hand["kd_before"])
    request = {"configuration": as_json(ARM), "options": {"axes": ["SpineX"]}}
    refusal = error(lab.operator.post(PATH, json=request), 422, "invalid_input")
    assert ELBOW in refusal["valid"]
    request["options"] = {"axes": ["Elbow"]}
    refusal = error(lab.operator.post(PATH, json=request), 422, "invalid_input")
    assert "which is no axis" in refusal["message"]
    request["options"] = {"relay_torques_nm": {ELBOW: 1.0, "SpineX": 1.0}}
    refusal = error(lab.operator.post(PATH, json=request), 422, "invalid_input")
    assert "given for SpineX, which" in refusal["message"]
    failed = settled(lab, begun(lab, relay_torque_nm=5000.0)["id"])
    assert failed["state"] == "failed"
    assert "no axis may take" in failed["trouble"]
    assert len(ok(lab.operator.get(PATH))) >= 2
