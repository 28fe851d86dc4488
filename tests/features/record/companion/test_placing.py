"""Tests of where a companion stands in the room, and of a performer's pose brought there."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.features.movement.performers import OnBody, reference_body
from app.features.movement.performers.performer import Performer, PerformerName
from app.features.record.companion.placing import (
    HALF_BODY_M,
    HIGHEST_HIPS_M,
    MIRROR_HALF_M,
    STRAYS_M,
    InRoom,
    Place,
    heading_of,
    standing_at,
)
from app.science.retargeting import REFERENCE_JOINT_MAP, example_walk
from app.science.rig import to_world
from tests.features.movement.performers.senders import by_json, samples
from tests.protocol.helpers import SHIPPED, loaded

PLACES: tuple[Place, ...] = ("ahead_left", "ahead_right", "left", "right")


def test_a_companion_leaves_mirror_and_boxes_free_and_faces_the_participant() -> None:
    """At every place, also at the edge of where they may stray, on the side that it names."""
    layouts = tuple(loaded(SHIPPED).protocol.tasks.layouts().values())
    boxes_m = max(
        abs(one.center_m[0]) + one.half_size_m[0] for layout in layouts for one in layout.surfaces
    )
    for place in PLACES:
        found = standing_at(place, layouts)
        x, z = found.position_m
        assert abs(x) - STRAYS_M - HALF_BODY_M >= max(MIRROR_HALF_M, boxes_m) - 1e-9
        assert z - STRAYS_M - HALF_BODY_M > -1.6
        assert (x < 0) == place.endswith("left")
        faced = (-math.sin(found.heading_rad), -math.cos(found.heading_rad))
        assert np.allclose(np.array(faced) * math.hypot(x, z), (-x, -z))


@pytest.mark.parametrize("place", PLACES)
def test_whoever_walks_stays_near_their_place_and_begins_facing_as_told(place: Place) -> None:
    """A walk of metres becomes steps on the spot; heights are those on the body's own floor."""
    walk = example_walk()
    performer = Performer(PerformerName("json", "mime", "Hips"), "here")
    body, in_room, far_m = None, None, 0.0
    standing = standing_at(place, ())
    for sample in samples("json", by_json(walk)):
        for frame in performer.take(sample, sample.skeletons[0]):
            agreed = performer.agreed
            assert agreed is not None
            if body is None or in_room is None:
                body = OnBody(agreed, REFERENCE_JOINT_MAP, reference_body("190cm"), "flat")
                in_room = InRoom(body, standing)
                first = in_room.values(frame).astype(float)
                assert np.allclose(first[[0, 2]], standing.position_m, atol=1e-6)
                assert _faced(body, first) == pytest.approx(standing.heading_rad, abs=1e-3)
            own, shown = body.values(frame), in_room.values(frame).astype(float)
            away = np.linalg.norm(shown[[0, 2]] - standing.position_m)
            far_m = max(far_m, float(np.linalg.norm(own[[0, 2]] - body.stood_m)))
            assert away <= STRAYS_M + 1e-6
            assert shown[1] == pytest.approx(own[1], abs=1e-6)
            assert np.allclose(shown[7:], own[7:], atol=1e-6)
    assert far_m > 1.0
    jumped = replace(frame, root_m=np.array((0.0, 9999.0, 0.0)))
    assert in_room is not None
    assert in_room.values(jumped)[1] == HIGHEST_HIPS_M


def _faced(body: OnBody, values: np.ndarray) -> float:
    """Return where a body faces, by its thighs."""
    rig = body.body.rig
    places, _ = to_world(rig, values[:3], values[3:].reshape(-1, 4))
    across = places[rig.index("RightUpperLeg")] - places[rig.index("LeftUpperLeg")]
    return heading_of((across[2], -across[0]))
