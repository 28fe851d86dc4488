"""Tests of scene files: what they can describe, and their error messages."""

import json
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.adapters.walks.scene_file import load_scene, load_shipped, shipped_scenes
from app.protocol.errors import ConfigError
from app.protocol.source import read_source
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.scene import area_m2, turning_per_m

SCENE = """
key: my-lab
title: My lab
bounds_m: [-2, -2, 2, 4]
clearance_m: 0.25
obstacles:
  - {shape: box, name: table, center_m: [0, 1], size_m: [1.2, 0.6], turned_deg: 90}
  - {shape: disc, name: pole, center_m: [1, 2], radius_m: 0.05}
  - {shape: wall, name: screen, from_m: [-2, 0], to_m: [-1, 0], thickness_m: 0.05}
  - {shape: polygon, name: corner, corners_m: [[1, -2], [2, -2], [2, -1]]}
places: {start: [0, -1], goal: [0, 3]}
paths:
  - {name: there, from: start, to: goal}
"""


def test_a_scene_file_gives_its_scene() -> None:
    """A scene file is read with all four shapes, turned boxes, places and paths."""
    scene = load_scene(SCENE)
    assert (scene.name, scene.title, scene.clearance_m) == ("my-lab", "My lab", 0.25)
    assert [obstacle.name for obstacle in scene.obstacles] == ["table", "pole", "screen", "corner"]
    table = scene.obstacles[0].corners_m
    assert np.ptp(table, axis=0) == pytest.approx([0.6, 1.2])
    areas = [area_m2(obstacle.corners_m) for obstacle in scene.obstacles]
    assert areas == pytest.approx([0.72, np.pi * 0.0025, 0.05, 0.5], rel=0.02)
    assert (scene.paths[0].start, scene.paths[0].goal) == ("start", "goal")
    assert scene.places["goal"] == (0.0, 3.0)


def test_json_is_read_too() -> None:
    """A scene file may be JSON, since that is YAML."""
    tree = {"key": "a", "bounds_m": [0, 0, 1, 1], "places": {"p": [0.5, 0.5]}}
    assert load_scene(json.dumps(tree)).places == {"p": (0.5, 0.5)}


@pytest.mark.parametrize(
    ("old", "new", "expected_message"),
    [
        ("[0, 1], size", "[0, .nan], size", r"line 7.*center_m\[1\].*nan.*finite"),
        ("size_m: [1.2, 0.6]", "size_m: [1.2, -0.6]", r"line 7.*size_m\[1\].*out of range"),
        ("shape: disc", "shape: ball", r"line 8.*shape is 'ball'.*box"),
        ("radius_m", "radius", r"line 8.*'radius'.*Did you mean 'radius_m'"),
        ("[2, -2], [2, -1]", "[2, -1], [2, -2]", r"line 10.*'corner'.*clockwise"),
        ("goal: [0, 3]", "goal: [0, 1]", r"line 11.*places.goal.*inside obstacle 'table'"),
        ("goal: [0, 3]", "goal: [0, 9]", r"line 11.*outside the scene's bounds"),
        ("to: goal", "to: gaol", r"line 13.*names 'gaol'; places are start, goal"),
        ("to: goal", "to: start", r"line 13.*ends where it begins"),
        ("[-2, -2, 2, 4]", "[-2, 4, 2, -2]", r"line 4.*near < far"),
        ("[-2, -2, 2, 4]", "[-2, -2, 2]", r"bounds_m"),
        ("key: my-lab", "key: My Lab", r"line 2.*key"),
        ("title: My lab", "tittle: My lab", r"line 3.*Did you mean 'title'"),
    ],
)
def test_each_problem_is_reported_with_its_line(old: str, new: str, expected_message: str) -> None:
    """Each problem is reported with its line, its path and what is valid."""
    text = SCENE.replace(old, new, 1)
    assert text != SCENE
    with pytest.raises(ConfigError) as refused:
        load_scene(text)
    assert any(re.search(expected_message, str(problem)) for problem in refused.value.problems)


def test_all_problems_are_reported_together() -> None:
    """A bad outline, a place in a table and an unknown goal of a scene file are all reported."""
    text = SCENE.replace("[2, -2], [2, -1]", "[2, -1], [2, -2]").replace("to: goal", "to: gaol")
    with pytest.raises(ConfigError) as refused:
        load_scene(text.replace("goal: [0, 3]", "goal: [0, 1]"))
    assert len(refused.value.problems) == 3


@pytest.mark.parametrize("text", ["", "- a", "key: [", "key: a\nbounds_m: *there"])
def test_files_that_are_no_scene_are_rejected(text: str) -> None:
    """An empty file, a list, broken YAML and an alias are rejected."""
    with pytest.raises(ConfigError):
        load_scene(text)


ODD: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    1e300,
    "",
    "x" * 500,
    [],
    {},
    [[]],
    [0, 0],
    [[0, 0]] * 3,
    {"a": 1},
)


@settings(max_examples=80, deadline=None)
@given(st.data())
def test_a_broken_scene_file_is_a_scene_or_a_list_of_problems(data: st.DataObject) -> None:
    """A scene file with any value replaced is read or rejected with problems."""
    tree = read_source(SCENE).tree
    node, key = _somewhere(tree, data)
    node[key] = data.draw(st.sampled_from(ODD))
    with suppress(ConfigError):
        scene = load_scene(json.dumps(tree))
        assert scene.bounds_m[0] < scene.bounds_m[2]


def _somewhere(tree: Any, data: st.DataObject) -> tuple[Any, Any]:
    """Draw a mapping or list of the tree, and one of its keys."""
    while True:
        keys = sorted(tree) if isinstance(tree, dict) else range(len(tree))
        key = data.draw(st.sampled_from(list(keys)))
        inner = tree[key]
        if not isinstance(inner, dict | list) or not inner or data.draw(st.booleans()):
            return tree, key
        tree = inner


@pytest.mark.parametrize("key", sorted(shipped_scenes()))
def test_shipped_scenes_say_what_they_assume(key: str) -> None:
    """Shipped scenes have their keys as names and describe what is not from the paper."""
    scene = load_shipped(key)
    assert scene.name == key
    assert "From the paper:" in scene.about
    assert "Assumed, since the paper does not say:" in scene.about


def test_paths_turn_at_both_workplaces() -> None:
    """Three walks of the first scene lead round a rack; all of the second by .3 rad/m or more."""
    turning = []
    for key in ("car-and-three-racks", "car-between-two-racks"):
        scene = load_shipped(key)
        planner = LazyThetaPlanner(scene)
        paths = [planner.plan(scene.places[one.start], scene.places[one.goal])
                 for one in scene.paths]  # fmt: skip
        turning.append([turning_per_m(path.points_m) for path in paths])
    assert sum(one > 0.1 for one in turning[0]) == 3
    assert min(turning[1]) >= 0.3


def test_the_documented_example_is_a_scene_with_every_shape() -> None:
    """The example in docs/walking.md can be read, and its obstacles have all four shapes."""
    page = (Path(__file__).parents[3] / "docs" / "walking.md").read_text(encoding="utf-8")
    block = page[page.index("    key: my-lab") : page.index("| Key | What it says |")]
    scene = load_scene("\n".join(line.removeprefix("    ") for line in block.splitlines()))
    assert [one.name for one in scene.obstacles] == ["table", "pole", "screen", "corner"]
    assert set(re.findall(r"shape: (\w+)", block)) == {"box", "disc", "wall", "polygon"}
