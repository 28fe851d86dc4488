"""Tests of a motion capture suit as a session's trackers."""

import time
from collections.abc import Iterator

import numpy as np
import pytest

from app.features.movement.live import DoorKey, Sample
from app.features.record.lab_trackers.bones import WornBones
from app.features.record.lab_trackers.link import TrackerLink
from app.science.rig import RigMotion
from tests.features.lab import ok
from tests.features.movement.performers.senders import (
    as_sent,
    by_json,
    by_natnet,
    by_vmc,
    part_of_walk,
    samples,
)
from tests.features.record.headset.site import Site
from tests.support.datagrams import HERE, free_udp_port, sending

LIMBS = ("Head", "Hips", "LeftHand", "LeftLowerLeg")
SUITS = ("json", "osc", "natnet in the parent", "natnet in the world")


@pytest.fixture(scope="module")
def walk() -> RigMotion:
    """Some frames of a generated walk."""
    return as_sent(part_of_walk(50, 70))


def suit(kind: str, walk: RigMotion) -> Iterator[Sample]:
    """Yield what arrives of a suit whose software sends it in one of the known ways."""
    if kind.startswith("natnet"):
        return samples("natnet", by_natnet(walk, in_parent=kind.endswith("parent")))
    door: DoorKey = "osc" if kind == "osc" else "json"
    return samples(door, by_vmc(walk) if kind == "osc" else by_json(walk))


@pytest.mark.parametrize("kind", SUITS)
def test_bones_are_where_they_are_in_the_room(kind: str, walk: RigMotion) -> None:
    """Head, hips, hand and shin of every frame, by every door, whatever frame poses are sent in."""
    places, rotations = walk.world()
    bones, frames = WornBones(), []
    for sample in suit(kind, walk):
        # Motive's bones have the name of their skeleton before their own.
        worn = {one.tracker for one in sample.poses if one.tracker.endswith(LIMBS)}
        frames += [found] if (found := bones.of(sample, worn)) else []
    assert len(frames) >= walk.frame_count - 1
    limbs = {next(limb for limb in LIMBS if one.tracker.endswith(limb)): one for one in frames[-1]}
    assert set(limbs) == set(LIMBS)
    for limb, one in limbs.items():
        joint = walk.rig.index(limb)
        assert one.tracked
        assert one.rotation is not None
        assert one.position_m == pytest.approx(tuple(places[-1, joint].tolist()), abs=1e-5)
        assert abs(np.dot(one.rotation, rotations[-1, joint])) == pytest.approx(1, abs=1e-6)


def test_a_tracker_that_is_strapped_on_counts_more_than_a_bone(walk: RigMotion) -> None:
    """The headset's own tracker is the reference, and the suit has the other limbs."""
    link = TrackerLink("json", "mime")
    bones = {one: one for one in LIMBS}
    link.wear({}, bones)
    assert link.reference == "Head"
    link.wear({"hat": "Head"}, bones)
    assert link.reference == "hat"
    newest = 0.0
    for sample in suit("json", walk):
        assert link.take(sample)
        newest = sample.arrival_s
    tracked = {one.tracker: one.tracked for one in link.trackers(newest)}
    assert tracked == {"hat": False, "Hips": True, "LeftHand": True, "LeftLowerLeg": True}


def test_a_suit_is_worn_without_saying_which_bone_is_which(site: Site) -> None:
    """Whoever chooses the source of a suit sees its limbs, and that the headset is waited for."""
    port = free_udp_port()
    door = {"is_open": True, "interface": HERE, "port": port}
    ok(site.operator.put("/api/trackers/doors/json", json=door))
    path = f"/api/sessions/{site.join()}/trackers"
    ok(site.operator.put(path, json={"door": "json", "source": "mime"}))
    walk = list(by_json(part_of_walk(50, 110)))
    deadline, shown = time.monotonic() + 20, {}
    with sending(port, lambda number: walk[number % len(walk)]):
        while time.monotonic() < deadline:
            shown = ok(site.operator.get(path))
            if shown["status"] == "no_headset":
                break
            time.sleep(0.1)
    assert shown["status"] == "no_headset"
    limbs = {one["limb"] for one in shown["trackers"] if one["used"]}
    assert limbs == {"Head", "Hips", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg"}
