"""Tests of `reembody pilot check`: each broken study is found and named."""

import json
from pathlib import Path
from typing import Any

import pytest

from app.cli.pilot.check import _paths
from tests.cli.invoked import Invoked
from tests.protocol.helpers import CONFIGS, SHIPPED

_COMMAND = Invoked("pilot")
_ONE_TASK = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
"""A study with a hand task only, which is checked in half the time."""
_ORDERS = """orders:
  design: explicit
  sequences:
    - [latency_0, latency_125, latency_350]
    - [latency_125, latency_0, latency_350]
"""
_DECLARED = """
preregistration:
  alpha: 0.05
  planned_n: 5
  primary:
    measure: completions
    limb: hand
    test: against_reference
    reference: latency_0
"""


def _checked(text: str, folder: Path) -> dict[str, Any]:
    file = folder / "study.yaml"
    file.write_text(text, encoding="utf-8")
    result = _COMMAND.run("check", file, "--json")
    checked = json.loads(result.stdout)
    assert result.exit_code == (1 if checked["problems"] else 0)
    assert isinstance(checked, dict)
    return checked


def _changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def test_the_shipped_study_can_be_run() -> None:
    """Short and tall people complete both tasks of the shipped study at 350 ms, in both orders."""
    result = _COMMAND.run("check", "reembodiment-latency")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("SIMULATED: reembodiment-latency, problems: 0")
    assert result.stdout.count(" 350 ms ") == 8


def test_a_box_out_of_reach_is_named(tmp_path: Path) -> None:
    """A box 2 m ahead is found with its place in the file and the bodies that miss it."""
    box = "{number: 1, center_m: [-0.33, 1.2, -0.55]"
    far = _changed(_ONE_TASK, box, box.replace("-0.55", "-2.00"))
    (problem,) = _checked(far, tmp_path)["problems"]
    assert problem["kind"] == "out_of_reach"
    assert problem["path"] == "tasks.hand.boxes[0]"
    assert "the 5th percentile of women (1.518 m) and the 95th percentile" in problem["message"]


@pytest.mark.parametrize(
    ("old", "new", "kind", "path"),
    [
        (
            "preparation_s: 5\n        duration_s: 60",
            "preparation_s: 5\n        duration_s: 7",
            "phase_too_short",
            "phases[0].duration_s",
        ),
        ("latency_ms: 200", "latency_ms: 2500", "latency_over_buffer", "conditions[1].latency_ms"),
    ],
)
def test_short_phases_and_long_latencies_are_named(
    tmp_path: Path, old: str, new: str, kind: str, path: str
) -> None:
    """A phase in which nothing can be completed and a latency beyond the buffer are found."""
    problems = _checked(_changed(_ONE_TASK, old, new), tmp_path)["problems"]
    assert [(one["kind"], one["path"].removeprefix("procedure.block.")) for one in problems] == [
        (kind, path)
    ]
    assert all(one["remedy"] for one in problems)


def test_unbalanced_orders_and_hopeless_numbers_are_named(tmp_path: Path) -> None:
    """Listed orders with a condition always last, an odd n, and a test of five are found."""
    orders = _changed(SHIPPED, "orders:\n  design: all_permutations\n", _ORDERS)
    problems = _checked(orders + _DECLARED, tmp_path)["problems"]
    by_kind = {one["path"]: one for one in problems}
    where = "0 times at position 1, 0 times at position 2, 2 times at position 3"
    assert f"latency_350 comes {where}" in by_kind["orders"]["message"]
    said = [one["message"] for one in problems if one["path"] == "preregistration.planned_n"]
    assert "5 participants do not fill 2 orders equally" in said[0]
    assert "0.0625 at best" in said[1]


_ROOM = """
key: our-room
bounds_m: [0, 0, 4, 4]
places: {door: [0.5, 2.0], boxes: [3.5, 2.0]}
paths: [{name: to the boxes, from: door, to: boxes}]
obstacles:
  - {name: wall, shape: wall, from_m: [2.0, 0.0], to_m: [2.0, END], thickness_m: 0.1}
"""


@pytest.mark.parametrize(("end", "found"), [("4.0", 1), ("2.5", 0)])
def test_a_scene_without_a_path_is_named(tmp_path: Path, end: str, found: int) -> None:
    """A wall across the room leaves no way from the door to the boxes; a shorter one does."""
    room = tmp_path / "room.yaml"
    room.write_text(_ROOM.replace("END", end), encoding="utf-8")
    problems = list(_paths(str(room)))
    assert [one.kind for one in problems] == ["scene_without_path"] * found
    assert all("'to the boxes' from 'door' to 'boxes'" in one.message for one in problems)


def test_a_shipped_scene_goes_by_its_key() -> None:
    """A scene that the product ships is found by its key, and another name says which there are."""
    assert list(_paths("car-and-three-racks")) == []
    with pytest.raises(ValueError, match=r"shipped with the product are .*car-and-three-racks"):
        list(_paths("nowhere"))


def test_an_invalid_file_is_refused_as_everywhere(tmp_path: Path) -> None:
    """A file with a mistake is refused with its line and what is valid, before any simulation."""
    (tmp_path / "study.yaml").write_text(_changed(SHIPPED, "replicates: 2", "replicates: 0"))
    assert "orders.replicates" in _COMMAND.refusal("check", tmp_path / "study.yaml")
