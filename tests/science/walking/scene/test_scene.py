"""Tests of scenes: outlines, clearance and validation."""

import numpy as np
import pytest

from app.science.walking.records.model import WalkingError
from app.science.walking.scene.laboratory import POLE_DEG, pole_scene, straight_scene
from app.science.walking.scene.scene import Obstacle, Scene, SceneError, ScenePath, box
from app.science.walking.scene.shapes import area_m2, contains, disc_corners, distance_m, widened

BOUNDS = (-2.0, -2.0, 2.0, 2.0)
TABLE = box("table", (0.0, 0.0), (1.0, 1.0))


def test_a_widened_outline_keeps_the_clearance_everywhere() -> None:
    """A widened outline keeps at least the clearance and at most 2 % more, at corners too."""
    outline = widened(TABLE.corners_m, 0.2)
    away = [distance_m(TABLE.corners_m, (float(x), float(y))) for x, y in outline]
    assert min(away) >= 0.2 - 1e-9
    assert max(away) <= 0.2 * 1.02
    assert area_m2(outline) == pytest.approx(1.0 + 4 * 0.2 + np.pi * 0.04, rel=0.01)


def test_the_polygon_of_a_disc_contains_the_disc() -> None:
    """Every point of a disc's circle lies within its polygon."""
    angles = np.linspace(0.0, 2.0 * np.pi, 100)
    circle = 0.999999 * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    assert contains(disc_corners((0.0, 0.0), 1.0), circle).all()


def test_a_start_near_an_obstacle_reduces_its_clearance() -> None:
    """A start closer than the clearance reduces the clearance of that obstacle only."""
    scene = Scene("near", BOUNDS, (TABLE, box("rack", (1.7, 1.7), (0.2, 0.2))))
    assert scene.is_near_obstacle((0.0, 0.6))
    outlines = scene.widened_obstacles((0.0, 0.6), (0.0, 1.5))
    assert not contains(outlines[0], np.array([0.0, 0.6]))
    assert outlines[1] == pytest.approx(widened(scene.obstacles[1].corners_m, 0.2))


@pytest.mark.parametrize(
    ("corners", "expected_message"),
    [
        ([[0, 0], [0, 1], [1, 1]], "clockwise"),
        ([[0, 0], [1, 0], [0.1, 0.1], [0, 1]], "not convex"),
        ([[0, 0], [1, 0], [2, 0]], "no area"),
        ([[0, 0], [1, 0]], "three corners"),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], "same corner twice"),
        ([[0, 0], [1, 0], [0, float("nan")]], "not finite"),
        ([[0, 0], [2, 2], [0, 2], [2, 0], [1, 3]], "not convex"),
    ],
)
def test_an_invalid_outline_is_rejected(corners: list[list[float]], expected_message: str) -> None:
    """An invalid outline raises an error that names it and states the reason."""
    with pytest.raises(SceneError, match=f"'thing'.*{expected_message}"):
        Obstacle("thing", np.array(corners, dtype=np.float64))


@pytest.mark.parametrize(
    ("place", "expected_message"),
    [
        ((0.2, 0.0), "inside obstacle 'table'"),
        ((9.0, 0.0), "outside the scene's bounds"),
        ((float("nan"), 0.0), "finite"),
    ],
)
def test_an_invalid_place_is_rejected(place: tuple[float, float], expected_message: str) -> None:
    """A place in an obstacle, out of bounds or not finite raises an error that names it."""
    with pytest.raises(SceneError, match=f"'goal'.*{expected_message}"):
        Scene("bad", BOUNDS, (TABLE,), {"goal": place})


def test_bounds_paths_and_clearance_are_checked() -> None:
    """Reversed bounds, a path to an unknown place and a negative clearance are rejected."""
    with pytest.raises(SceneError, match="left < right"):
        Scene("bad", (2.0, 0.0, -2.0, 1.0))
    with pytest.raises(SceneError, match="'goal'; places are start"):
        Scene("bad", BOUNDS, (), {"start": (0, 0)}, (ScenePath("there", "start", "goal"),))
    with pytest.raises(SceneError, match="clearance"):
        Scene("bad", BOUNDS, clearance_m=-0.1)


@pytest.mark.parametrize("turn", POLE_DEG)
def test_the_poles_scenes_have_places_for_start_and_goal(turn: float) -> None:
    """Start and goal of the pole scenes are free, and half the walk away from the pole."""
    scene = pole_scene(turn, 3.0)
    for place in scene.places.values():
        assert not scene.is_near_obstacle(place)
        assert np.hypot(*place) == pytest.approx(np.hypot(1.5, 0.3), abs=1e-9)


def test_impossible_laboratory_scenes_are_rejected() -> None:
    """A walk without length and a turn beyond half a circle are rejected."""
    with pytest.raises(WalkingError):
        straight_scene(0.0)
    with pytest.raises(WalkingError):
        pole_scene(270.0, 3.0)
