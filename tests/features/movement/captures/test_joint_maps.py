"""Tests of joint maps: proposed, saved in versions per skeleton, and validated."""

import pytest

from app.models import SavedJointMap
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.captures.files import uploaded, walk_bvh


def joint_map_path(view: Json) -> str:
    """Return the address of a capture's joint map."""
    return f"/api/captures/{view['id']}/joint-map"


@pytest.mark.one_engine
def test_a_joint_map_is_proposed_from_names(fresh_lab: Lab) -> None:
    """A joint map is proposed from joint names, and lists what is unmapped on both sides."""
    view = uploaded(fresh_lab.operator, walk_bvh())
    reply = ok(fresh_lab.operator.get(joint_map_path(view)))
    assert (reply["version"], reply["chosen"], reply["by"]) == (0, False, None)
    assert reply["joint_map"]["LeftUpperLeg"] == "LeftUpLeg"
    assert reply["sources"]["LeftUpperLeg"] == "name"
    assert reply["joint_map"] == reply["proposal"]
    assert reply["unmapped_body_joints"] == ["UpperChest"]
    assert reply["unmapped_rig_joints"] == []
    assert reply["rig_joints"] == view["summary"]["names"]
    assert (reply["usable"], reply["missing"], reply["captures"]) == (True, [], 1)


def test_a_saved_joint_map_applies_to_every_capture_of_the_skeleton(fresh_lab: Lab) -> None:
    """A saved joint map applies to every capture of the same skeleton and keeps its versions."""
    first = uploaded(fresh_lab.operator, walk_bvh())
    second = uploaded(fresh_lab.operator, walk_bvh(60), "short.bvh")
    reply = ok(fresh_lab.operator.get(joint_map_path(first)))
    changed = {k: v for k, v in reply["joint_map"].items() if k != "LeftToes"}
    request = {"joint_map": changed, "version": 0}
    saved = ok(fresh_lab.operator.put(joint_map_path(first), json=request))
    assert (saved["version"], saved["chosen"], saved["by"]) == (1, True, "account:admin")
    assert saved["joint_map"] == changed
    assert saved["unmapped_body_joints"] == ["UpperChest", "LeftToes"]
    assert saved["unmapped_rig_joints"] == ["LeftToeBase"]
    assert set(saved["sources"].values()) == {"chosen"}
    assert saved["captures"] == 2
    assert ok(fresh_lab.operator.get(joint_map_path(second))) == saved
    back = ok(fresh_lab.operator.delete(f"{joint_map_path(second)}?version=1"))
    assert (back["version"], back["chosen"]) == (2, False)
    assert back["joint_map"] == reply["joint_map"]
    with fresh_lab.database.reading() as db:
        rows = db.query(SavedJointMap).order_by(SavedJointMap.version).all()
    assert [(row.version, row.chosen) for row in rows] == [(1, True), (2, False)]
    trail = ok(fresh_lab.operator.get("/api/audit?action=capture."))["entries"]
    assert [one["action"] for one in trail[:2]] == ["capture.unmapped", "capture.mapped"]


def test_saving_on_an_outdated_version_is_refused(fresh_lab: Lab) -> None:
    """Saving a joint map based on an outdated version is refused with the newest number."""
    view = uploaded(fresh_lab.operator, walk_bvh())
    reply = ok(fresh_lab.operator.get(joint_map_path(view)))
    request = {"joint_map": reply["joint_map"], "version": 0}
    ok(fresh_lab.operator.put(joint_map_path(view), json=request))
    refusal = error(fresh_lab.operator.put(joint_map_path(view), json=request), 409, "stale")
    assert (refusal["value"], refusal["valid"]) == (0, 1)
    error(fresh_lab.operator.delete(f"{joint_map_path(view)}?version=0"), 409, "stale")


@pytest.mark.one_engine
def test_an_invalid_joint_map_is_refused(fresh_lab: Lab) -> None:
    """A joint map with unknown, duplicate or missing joints is refused with every problem."""
    view = uploaded(fresh_lab.operator, walk_bvh())
    reply = ok(fresh_lab.operator.get(joint_map_path(view)))
    wrong = {**reply["joint_map"], "Tail": "Spine", "Head": "Hut", "LeftHand": "RightHand"}
    del wrong["Hips"]
    request = {"joint_map": wrong, "version": 0}
    refusal = error(
        fresh_lab.operator.put(joint_map_path(view), json=request), 422, "invalid_input"
    )
    assert {"Tail", "Head", "LeftHand", "RightHand", "Hips"} <= {
        one["path"] for one in refusal["details"]
    }
    assert refusal["valid"]["joints"] == reply["rig_joints"]
    assert ok(fresh_lab.operator.get(joint_map_path(view)))["version"] == 0
