"""Tests that walks are compared with agents on the path that people really took."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.rotations import FloatArray
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import LeftOut, Recorded, entry_of, rounds_of, walks_of
from app.science.walking.records import LENGTH, TURNING, PlannedWalk, Track, Walk
from app.science.walking.scene import Obstacle, Scene, box_corners, open_scene

RATE_HZ = 100.0


def _track(course: FloatArray) -> Track:
    """Return a track along points 1 cm apart at about 1.2 m/s, with rest before and after."""
    share = np.linspace(0.0, 1.0, round(RATE_HZ * len(course) * 0.01 / 0.65))
    eased = 10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5
    at = np.concatenate([np.zeros(100), eased * (len(course) - 1), np.full(100, len(course) - 1.0)])
    places = np.arange(len(course))
    xy_m = np.stack([np.interp(at, places, course[:, axis]) for axis in (0, 1)], axis=-1)
    return Track(np.arange(len(at)) / RATE_HZ, xy_m, "7", "made", "synthetic")


def _arc(length_m: float, turning_rad: float) -> FloatArray:
    """Return points 1 cm apart on an arc of a circle."""
    along = np.arange(0.0, length_m, 0.01)
    if turning_rad == 0.0:
        return np.stack([along, np.zeros_like(along)], axis=-1)
    radius = length_m / turning_rad
    return radius * np.stack([np.sin(along / radius), 1.0 - np.cos(along / radius)], axis=-1)


def _entry(walk: Walk, scene: Scene | None = None) -> PlannedWalk | LeftOut:
    floor = scene or open_scene(walk.start_m, walk.goal_m)
    return entry_of(walk, LazyThetaPlanner(floor))


def test_a_curved_walk_gets_its_own_path() -> None:
    """A walk of 15 m that turns by 650 degrees is fitted as 15 m, not as the .34 m to its end."""
    turning_rad = np.radians(650.0)
    (walk,) = walks_of(_track(_arc(15.0, turning_rad)))
    entry = _entry(walk)
    assert isinstance(entry, PlannedWalk)
    assert entry.is_own_path
    # The filter that removes the sway also cuts the curve a little.
    assert entry.path.length_m == pytest.approx(15.0, rel=0.03)
    assert entry.dependencies[LENGTH] == entry.path.length_m
    assert entry.dependencies[TURNING] * entry.path.length_m == pytest.approx(turning_rad, rel=0.03)
    np.testing.assert_allclose(entry.path.points_m[[0, -1]], walk.xy_m[[0, -1]], atol=0.01)


@pytest.mark.parametrize("turning_deg", [30.0, 45.0, 75.0])
def test_a_slightly_curved_walk_gets_its_own_path(turning_deg: float) -> None:
    """An arc that is 1 to 7 % longer than its chord has its own turning, not that of the chord."""
    turning_rad = np.radians(turning_deg)
    (walk,) = walks_of(_track(_arc(4.0, turning_rad)))
    entry = _entry(walk)
    assert isinstance(entry, PlannedWalk)
    assert entry.is_own_path
    assert entry.dependencies[TURNING] * entry.path.length_m == pytest.approx(turning_rad, rel=0.06)


@pytest.mark.parametrize("sway_m", [0.0, 0.03])
def test_a_straight_walk_keeps_the_planned_path(sway_m: float) -> None:
    """The sway of strides, 3 cm to either side, does not make a straight walk a curved one."""
    course = _arc(5.0, 0.0)
    course[:, 1] += sway_m * np.sin(2.0 * np.pi * course[:, 0] / 1.4)
    (walk,) = walks_of(_track(course))
    entry = _entry(walk)
    assert isinstance(entry, PlannedWalk)
    assert not entry.is_own_path
    assert len(entry.path.points_m) == 2


def test_a_round_is_named_and_is_no_walk() -> None:
    """A round that ends where it began is no walk between two places, and is returned as such."""
    track = _track(_arc(9.0, 2.0 * np.pi))
    assert walks_of(track) == []
    (found,) = rounds_of(track)
    assert found.length_m == pytest.approx(9.0, rel=0.02)
    assert rounds_of(_track(_arc(0.5, 0.0))) == []


def test_a_walk_through_an_obstacle_is_left_out() -> None:
    """A walk that is shorter than any way round the scene's wall is left out with the reason."""
    (walk,) = walks_of(_track(_arc(4.0, 0.0)))
    wall = Obstacle("wall", box_corners((2.0, 0.0), (0.2, 3.0)))
    hall = Scene("hall", (-1.0, -4.0, 5.0, 4.0), (wall,))
    found = _entry(walk, hall)
    assert isinstance(found, LeftOut)
    assert "crosses an obstacle" in found.reason


def test_a_recording_given_twice_is_no_second_person() -> None:
    """The same samples under another name, moved on the floor, are found; other walks are not."""
    recorded, walk = Recorded(), walks_of(_track(_arc(4.0, 1.0)))[0]
    assert recorded.objection(walk, "first") is None
    copy = replace(walk, xy_m=walk.xy_m + np.array([2.0, -1.0]), subject="somebody else")
    assert recorded.objection(copy, "second") == (
        "it is the same recording as first, sample for sample"
    )
    assert recorded.objection(replace(walk, xy_m=walk.xy_m * 1.02), "third") is None


def test_a_walk_faster_than_anybody_walks_is_named() -> None:
    """Centimetres read as metres, of a slow crowd, or a wrong rate, are named by their speed."""
    walk = walks_of(_track(_arc(4.0, 1.0)))[0]
    fast = replace(walk, times_s=walk.times_s / 10.0)
    objection = Recorded().objection(fast, "fast")
    assert objection is not None
    assert "faster than anybody walks" in objection
