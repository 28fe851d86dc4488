"""Skeletons in packets: which bones belong together, and what is damaged is counted."""

import json

import pytest

from app.adapters.live import JsonTrackers, NatNetClient, human_skeleton
from tests.adapters.live.packets import definitions, frame, server_info

REST = (1.0, 0.0, 0.0, 0.0)
NAMES = {1: "Hip", 2: "Ab", 3: "LThigh", 4: "LShin"}
TREE = {
    1: (0, (0.0, 0.0, 0.0)),
    2: (1, (0.0, 0.1, 0.0)),
    3: (1, (-0.1, 0.0, 0.0)),
    4: (3, (0.0, -0.4, 0.0)),
}


def scripted(trackers: dict[str, str | None]) -> bytes:
    """Return a packet of a script whose trackers have these parents."""
    pose = {"position_m": [0, 1, 0], "rotation_wxyz": [1, 0, 0, 0]}
    sent = {
        name: pose if above is None else {**pose, "parent": above}
        for name, above in trackers.items()
    }
    return json.dumps({"source": "mime", "trackers": sent}).encode()


def test_a_script_s_bones_are_a_skeleton_with_parents_first() -> None:
    """Given in any order; what is no bone stays a tracker, and two bodies are two skeletons."""
    given = {"head": "hips", "hips": None, "foot": "leg", "leg": "hips", "prop": None}
    reading = JsonTrackers().read(scripted({**given, "tail": "dog", "dog": None}))
    first, second = reading.skeletons
    assert [(one.tracker, one.parent) for one in first.bones] == [
        ("hips", None),
        ("head", "hips"),
        ("leg", "hips"),
        ("foot", "leg"),
    ]
    assert [one.tracker for one in second.bones] == ["dog", "tail"]
    kinds = {one.tracker: one.kind for one in reading.poses}
    assert kinds == dict.fromkeys((*given, "tail", "dog"), "bone") | {"prop": "tracker"}
    assert not reading.problems


def test_bones_below_nothing_are_refused_and_counted() -> None:
    """A parent that is not sent, a circle, and what hangs on either: the rest is used."""
    reading = JsonTrackers().read(
        scripted({"a": "b", "b": "a", "on a": "a", "lone": "nobody", "hips": None, "leg": "hips"})
    )
    assert reading.problems == {"arguments": 4}
    assert {one.tracker for one in reading.poses} == {"hips", "leg"}
    assert len(reading.skeletons) == 1


@pytest.mark.parametrize("version", [(2, 10), (3, 0), (4, 1)])
def test_motive_s_definitions_tell_parents_and_offsets(version: tuple[int, int]) -> None:
    """In every version; ids of frames have the skeleton's in their upper half."""
    client = NatNetClient()
    client.read(server_info(version))
    told = client.read(definitions(version, {}, {7: ("Ann", NAMES)}, TREE))
    assert not told.problems
    rows = [(one, TREE[one][1], REST, True) for one in NAMES]
    reading = client.read(frame(version, 1, 0.5, (), {7: rows}))
    (skeleton,) = reading.skeletons
    assert (skeleton.name, skeleton.in_parent) == ("Ann", None)
    assert [one.tracker for one in skeleton.bones] == [
        "Ann_Hip",
        "Ann_Ab",
        "Ann_LThigh",
        "Ann_LShin",
    ]
    assert [one.parent for one in skeleton.bones] == [None, "Ann_Hip", "Ann_Hip", "Ann_LThigh"]
    assert skeleton.bones[3].offset_m == pytest.approx((0.0, -0.4, 0.0))
    assert {one.tracker for one in reading.poses} >= {one.tracker for one in skeleton.bones}


@pytest.mark.parametrize(
    ("bone", "place"),
    [
        (4, (99, (0.0, 0.1, 0.0))),
        (3, (4, (0.0, 0.1, 0.0))),
        (1, (2, (0.0, 0.1, 0.0))),
        (2, (1, (float("nan"), 0.1, 0.0))),
        (2, (1, (0.0, 1e9, 0.0))),
    ],
    ids=["no such parent", "circle", "no root", "not a number", "too far"],
)
def test_a_damaged_definition_is_counted_and_its_names_are_used(
    bone: int, place: tuple[int, tuple[float, float, float]]
) -> None:
    """The bones still have their names, and the other skeleton is whole."""
    client = NatNetClient()
    client.read(server_info((3, 0)))
    one = client.read(definitions((3, 0), {}, {7: ("Ann", NAMES)}, {**TREE, bone: place}))
    assert sum(one.problems.values()) == 1
    rows = [(each, (0.0, 0.0, 0.0), REST, True) for each in NAMES]
    reading = client.read(frame((3, 0), 1, 0.5, (), {7: rows}))
    assert reading.skeletons == ()
    assert "Ann_Hip" in {pose.tracker for pose in reading.poses}


def test_a_unity_avatar_s_bones_hang_on_the_nearest_one_above() -> None:
    """Without a chest the neck hangs on the spine; other names are left out; hips are needed."""
    sent = {"Hips", "Spine", "Neck", "Head", "LeftEye", "LeftHand", "LeftIndexDistal", "Weapon"}
    found = human_skeleton(sent)
    assert found is not None
    assert {one.tracker: one.parent for one in found.bones} == {
        "Hips": None,
        "Spine": "Hips",
        "Neck": "Spine",
        "Head": "Neck",
        "LeftEye": "Head",
        "LeftHand": "Spine",
        "LeftIndexDistal": "LeftHand",
    }
    assert human_skeleton({"Spine", "Head"}) is None
