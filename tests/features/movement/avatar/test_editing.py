"""Tests of editing avatar configurations over HTTP: operations, what they change and lose."""

import json
from dataclasses import replace

import pytest
from pydantic import TypeAdapter

from app.features.movement.avatar.schemas import MAX_OPERATIONS
from app.features.movement.avatar.service import shipped_configurations
from app.protocol.avatar import file_of, load_avatar, loaded
from app.protocol.avatar_editing import Operation, edited
from app.science.avatar.configuration import Configuration, lock, mirrored, with_global
from app.science.avatar.mjcf import default_configuration
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import new, save

SHIPPED = default_configuration()
PATH = "/api/avatars/edit"


def body(configuration: Configuration, *operations: Json) -> Json:
    """Return a request to edit a configuration."""
    file = file_of(configuration).model_dump(mode="json")
    return {"configuration": file, "operations": list(operations)}


@pytest.mark.one_engine
def test_operations_change_a_configuration_and_store_nothing(fresh_lab: Lab) -> None:
    """Operations give the same content as the functions in Python, and no version is stored."""
    answer = ok(
        fresh_lab.operator.post(
            PATH,
            json=body(
                SHIPPED,
                {"operation": "set_gains", "targets": ["left_arm"], "kp_nm_per_rad": 50.0},
                {"operation": "mirror", "direction": "left_to_right"},
                {"operation": "lock", "group": "LeftHand"},
            ),
        )
    )
    expected = lock(
        mirrored(with_global(SHIPPED, group="left_arm", kp=50.0), "left_to_right"), "LeftHand"
    )
    assert answer["content_hash"] == loaded(expected).content_hash
    assert (answer["problems"], answer["lost"]) == ([], [])
    kp = next(one for one in answer["changed"] if one["path"] == "axes.LeftHandZ.kp_nm_per_rad")
    assert kp == {
        "path": "axes.LeftHandZ.kp_nm_per_rad",
        "field": "kp_nm_per_rad",
        "part": "LeftHand",
        "axis": "LeftHandZ",
        "groups": ["left_arm"],
        "unit": "N m/rad",
        "old": SHIPPED.axes["LeftHandZ"].kp,
        "new": 50.0,
    }
    assert len(answer["changed"]) == 2 * 9 + 1
    (standard,) = ok(fresh_lab.operator.get("/api/avatars"))
    assert standard["versions"] == 2


def test_a_saved_version_is_read_once_however_often_it_is_loaded() -> None:
    """Reading and checking it for each of many operations would keep a server busy."""
    read: list[tuple[str, int | None]] = []

    def saved(key: str, number: int | None) -> Configuration:
        read.append((key, number))
        return lock(SHIPPED, "LeftHand")

    whole, arm = ({"operation": "load", "key": "standard"} | one for one in ({}, {"version": 1}))
    operations = TypeAdapter(list[Operation]).validate_python([whole, arm] * 3)
    assert edited(SHIPPED, operations, saved).configuration == lock(SHIPPED, "LeftHand")
    assert read == [("standard", None), ("standard", 1)]


@pytest.mark.one_engine
def test_an_unknown_body_and_too_many_operations_are_told(fresh_lab: Lab) -> None:
    """A body that is not here is a problem before an edit is saved; a long list is refused."""
    post = fresh_lab.operator.post
    answer = ok(post(PATH, json=body(replace(SHIPPED, humanoid="0" * 64))))
    (problem,) = answer["problems"]
    assert (problem["path"], problem["value"]) == ("humanoid", "0" * 64)
    load = {"operation": "load", "key": "standard"}
    refused = error(
        post(PATH, json=body(SHIPPED, *[load] * (MAX_OPERATIONS + 1))), 422, "invalid_input"
    )
    assert str(MAX_OPERATIONS) in refused["details"][0]["message"]


@pytest.mark.one_engine
def test_a_conversion_says_what_it_loses_before_it_is_saved(fresh_lab: Lab) -> None:
    """Converting to one joint per part lists every lost value, and fits that template then."""
    convert = {"operation": "convert", "to": "single", "targets": ["LeftFoot"]}
    answer = ok(fresh_lab.operator.post(PATH, json=body(SHIPPED, convert)))
    lost = {one["change"]["path"]: one for one in answer["lost"]}
    low = lost["axes.LeftFootZ.low_deg"]
    assert (low["change"]["old"], low["change"]["new"]) == (-25.0, -35.0)
    assert "greater of both sides, 35 deg" in low["reason"]
    assert answer["joints"]["LeftFoot"]["limits_deg"] == {"LeftFootY": 20.0, "LeftFootZ": 35.0}
    assert not answer["fits_single_template"]
    convert = {"operation": "convert", "to": "single"}
    whole = ok(fresh_lab.operator.post(PATH, json=body(SHIPPED, convert)))
    assert whole["fits_single_template"]
    back = body(SHIPPED, convert, {"operation": "convert", "to": "multiple"})
    assert ok(fresh_lab.operator.post(PATH, json=back))["content_hash"] == whole["content_hash"]


@pytest.mark.one_engine
def test_an_impossible_operation_changes_nothing(fresh_lab: Lab) -> None:
    """Problems name the operation and the value; the configuration comes back as it was."""
    soft = {"operation": "set_gains", "targets": ["head"], "kp_nm_per_rad": 1.0}
    for wrong, path in (
        ({"operation": "set_limits", "targets": ["HeadX"], "low_deg": 90.0}, "axes.HeadX.low_deg"),
        ({"operation": "load", "key": "nobody"}, "key"),
        ({"operation": "load", "key": "standard", "version": 9}, "version"),
        ({"operation": "load"}, "key"),
        ({"operation": "load", "key": "No key"}, None),
        ({"operation": "set_gains", "targets": ["all"]}, ""),
        ({"operation": "lock", "group": "HeadX"}, None),
        ({"operation": "set_gains", "targets": ["nowhere"], "kp_factor": 2.0}, None),
    ):
        answer = fresh_lab.operator.post(PATH, json=body(SHIPPED, soft, wrong))
        if path is None:
            assert error(answer, 422, "invalid_input")["details"]
            continue
        told = ok(answer)
        assert told["content_hash"] == loaded(SHIPPED).content_hash
        assert told["changed"] == []
        (problem,) = told["problems"]
        assert (problem["operation"], problem["path"]) == (1, path)
        assert problem["message"].endswith(".")


@pytest.mark.one_engine
def test_an_unknown_body_is_told_before_it_is_saved(fresh_lab: Lab) -> None:
    """Choosing a body that is not here is a problem of the result, and changes nothing."""
    unknown = {"operation": "set_model", "humanoid": 64 * "0"}
    answer = ok(fresh_lab.operator.post(PATH, json=body(SHIPPED, unknown)))
    (problem,) = answer["problems"]
    assert (problem["operation"], problem["path"]) == (None, "humanoid")
    assert answer["configuration"]["humanoid"] is None


@pytest.mark.one_engine
def test_groups_are_reset_to_a_saved_version(fresh_lab: Lab) -> None:
    """A group takes the gains and limits of a saved version; the rest stays as it was edited."""
    standard = shipped_configurations()[-1]
    soft = with_global(standard, kp=1.0, kd=1.0)
    reset = {"operation": "load", "key": "standard", "targets": ["left_leg", "head"]}
    answer = ok(fresh_lab.operator.post(PATH, json=body(soft, reset)))
    axes = answer["configuration"]["axes"]
    assert axes["LeftFootX"]["kp_nm_per_rad"] == standard.axes["LeftFootX"].kp
    assert axes["RightFootX"]["kp_nm_per_rad"] == 1.0
    whole = ok(
        fresh_lab.operator.post(PATH, json=body(soft, {"operation": "load", "key": "standard"}))
    )
    assert whole["content_hash"] == loaded(standard).content_hash


@pytest.mark.one_engine
def test_layers_delays_and_masses_are_edited(fresh_lab: Lab) -> None:
    """One cell of the layers' matrix, delays of a group and shares of the mass can be edited."""
    answer = ok(
        fresh_lab.operator.post(
            PATH,
            json=body(
                SHIPPED,
                {"operation": "set_layers", "layers": ["left_hand", "torso"], "collide": False},
                {"operation": "set_delays", "targets": ["LeftHand"], "delay_ms": 35.5},
                {"operation": "set_masses", "population": "female", "percent": {"Head": 8.5}},
                {"operation": "set_compliance", "targets": ["left_leg"], "stiffness_percent": 10.0},
                {"operation": "set_compliance", "targets": ["left_leg"], "limb_targets": "world"},
            ),
        )
    )
    changed = {one["path"]: (one["old"], one["new"], one["unit"]) for one in answer["changed"]}
    assert changed == {
        "population": ("average", "female", ""),
        "layers": (None, [{"layers": ["torso", "left_hand"], "collide": False}], ""),
        "delays_ms.LeftHand": (None, 35.5, "ms"),
        "relative_masses_percent.Head": (None, 8.5, "%"),
        "compliance.left_leg.stiffness_percent": (None, 10.0, "%"),
        "compliance.left_leg.targets": (None, "world", ""),
    }
    read = load_avatar(json.dumps(answer["configuration"]))
    assert read.content_hash == answer["content_hash"]


@pytest.mark.one_engine
def test_only_who_may_save_avatars_may_edit_them(fresh_lab: Lab) -> None:
    """Experimenters edit; operators and analysts are refused, and get the joints to read."""
    request = body(SHIPPED, {"operation": "set_masses", "total_mass_kg": 80.0})
    answer = ok(sign_in(fresh_lab, "experimenter").post(PATH, json=request))
    assert answer["changed"][0]["unit"] == "kg"
    for role in ("operator", "analyst"):
        reader = sign_in(fresh_lab, role)
        error(reader.post(PATH, json=request), 403, "not_allowed")
        version = ok(reader.get("/api/avatars/standard/versions/1"))
        assert version["joints"] == answer["joints"]


@pytest.mark.one_engine
def test_the_difference_of_two_versions_is_by_value_and_by_group(fresh_lab: Lab) -> None:
    """Two versions differ by named values, summed up by body group, with their notes."""
    tell = "/api/avatars/soft/versions/1/difference/2"
    new(fresh_lab, "soft", SHIPPED)
    save(fresh_lab, "soft", lock(with_global(SHIPPED, group="head", kd=2.0), "LeftHand"), 1)
    told = ok(fresh_lab.operator.get(tell))
    assert (told["old"]["note"], told["new"]["number"], told["same"]) == ("for the pilot", 2, False)
    assert told["changed"][0]["path"] == "locked_groups"
    assert [one["path"] for one in told["changed"][1:]] == [
        f"axes.{part}{letter}.kd_nm_s_per_rad" for part in ("Neck", "Head") for letter in "XZY"
    ]
    assert told["groups"] == [{"group": "head", "parts": ["Neck", "Head"], "values": 6}]
    back = ok(fresh_lab.operator.get("/api/avatars/soft/versions/2/difference/1"))
    swapped = [{**one, "old": one["new"], "new": one["old"]} for one in told["changed"]]
    assert back["changed"] == swapped
    assert ok(fresh_lab.operator.get(tell.replace("/2", "/1")))["same"]
    error(fresh_lab.operator.get(tell.replace("/2", "/3")), 404, "not_found")
