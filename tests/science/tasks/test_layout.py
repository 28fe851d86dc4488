"""Tests that boxes become surfaces that enclose their cavity, or are rejected."""

from dataclasses import replace
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.tasks import (
    BlockSpec,
    BoxSpec,
    LayoutError,
    Limb,
    Side,
    Surface,
    TaskLayout,
    build_layout,
)
from tests.science.tasks.vector_files import layout, read_all

HAND_BOXES = tuple(BoxSpec(n, (0.4 * n - 1.0, 1.2, -0.5), (0.25, 0.2, 0.3)) for n in (1, 2, 3, 4))
FOOT_BOXES = tuple(BoxSpec(n, (0.4 * n - 1.0, 0.1, -0.6), (0.2, 0.2, 0.4)) for n in (1, 2, 3, 4))
CUBE = BlockSpec((0.0, 1.6, -0.5), (0.1, 0.1, 0.1))
BAR = BlockSpec((0.0, 0.02, -1.0), (1.6, 0.04, 0.2))
START = BlockSpec((0.0, 0.0, 0.0), (0.5, 0.01, 0.5))


def hand(**changes: Any) -> TaskLayout:
    """Return a hand layout with some arguments changed."""
    given: dict[str, Any] = {
        "limb": Limb.HAND,
        "boxes": HAND_BOXES,
        "target": CUBE,
        "wall_thickness_m": 0.02,
        "panel_thickness_m": 0.01,
        "reverse_after_task": True,
    }
    return build_layout(**(given | changes))


def foot(**changes: Any) -> TaskLayout:
    """Return a foot layout with some arguments changed."""
    given = {"limb": Limb.FOOT, "boxes": FOOT_BOXES, "target": BAR, "start_square": START}
    return hand(**(given | changes))


def overlap_m(one: Surface, other: Surface) -> float:
    """Return how deep two surfaces overlap, negative if they are apart."""
    return min(
        one.half_size_m[axis]
        + other.half_size_m[axis]
        - abs(one.center_m[axis] - other.center_m[axis])
        for axis in range(3)
    )


@given(st.floats(0.05, 0.3), st.floats(0.05, 0.3), st.floats(0.05, 0.3), st.floats(0.001, 0.04))
def test_surfaces_of_a_layout_never_overlap(
    width_m: float, height_m: float, depth_m: float, wall_m: float
) -> None:
    """Panels, walls and rim bars touch but never overlap, whatever the sizes."""
    boxes = tuple(replace(box, inner_size_m=(width_m, height_m, depth_m)) for box in HAND_BOXES)
    sides = (Side.LEFT, Side.RIGHT, Side.TOP, Side.BOTTOM, Side.FRONT_RIM)
    surfaces = hand(boxes=boxes, sides=sides, wall_thickness_m=wall_m).surfaces
    assert max(overlap_m(*pair) for pair in combinations(surfaces, 2)) < 1e-9


def test_surfaces_come_box_by_box_then_target_then_start() -> None:
    """Surfaces are ordered by box, then target and start, and keyed by limb, box and side."""
    keys = [surface.key for surface in foot().surfaces]
    first = ["foot/1/panel", "foot/1/left", "foot/1/right", "foot/1/front", "foot/1/back"]
    assert (first, ["foot/target", "foot/start"]) == (keys[:5], keys[-2:])
    assert len(keys) == 22


def test_hand_boxes_open_towards_the_participant() -> None:
    """A hand box has its panel at the -z end and is open at the +z end."""
    surfaces = hand().by_key
    panel = surfaces["hand/1/panel"]
    assert panel.center_m == pytest.approx((-0.6, 1.2, -0.655))
    assert panel.half_size_m == pytest.approx((0.125, 0.1, 0.005))
    left = surfaces["hand/1/left"]
    assert left.center_m[2] + left.half_size_m[2] == pytest.approx(-0.35)


def test_foot_boxes_open_at_the_top() -> None:
    """A foot box has its panel at the bottom and is open at the top; front is nearer (+z)."""
    surfaces = foot().by_key
    panel = surfaces["foot/2/panel"]
    assert panel.center_m[1] + panel.half_size_m[1] == pytest.approx(0.0)
    assert surfaces["foot/2/front"].center_m[2] == pytest.approx(-0.39)
    assert surfaces["foot/2/back"].center_m[2] == pytest.approx(-0.81)


def test_only_configured_sides_exist() -> None:
    """Sides that are not configured are not built."""
    surfaces = hand(sides=(Side.LEFT, Side.BOTTOM)).by_key
    assert "hand/1/top" not in surfaces
    left = surfaces["hand/1/left"]
    assert left.center_m[1] + left.half_size_m[1] == pytest.approx(1.3)
    assert left.center_m[1] - left.half_size_m[1] == pytest.approx(1.08)


def test_rim_bars_are_one_side() -> None:
    """Each wall has a rim bar, and all bars of a box form one side."""
    bars = [s for s in layout("hand_rim").surfaces if s.side is Side.FRONT_RIM and s.box == 2]
    assert len(bars) == 4
    assert {bar.unit for bar in bars} == {"hand/2/front_rim"}


def test_vector_layouts_are_mirror_images_of_themselves() -> None:
    """The layouts of the vectors are symmetric, so that mirrored tasks can be compared."""
    for spec in read_all()["layouts"]["layouts"].values():
        centers = {tuple(surface["center_m"]) for surface in spec["surfaces"]}
        assert {(-x or 0.0, y, z) for x, y, z in centers} == centers


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wall_thickness_m": 0.0}, "wall_thickness_m is 0.0"),
        ({"panel_thickness_m": float("nan")}, "panel_thickness_m is nan"),
        ({"boxes": ()}, "Number the boxes"),
        ({"boxes": HAND_BOXES[1:]}, r"numbers are \[2, 3, 4\]"),
        ({"boxes": (replace(HAND_BOXES[0], inner_size_m=(0.2, -0.2, 0.2)),)}, "Box 1 has inner"),
        ({"boxes": (replace(HAND_BOXES[0], center_m=(0.0, float("inf"), 0.0)),)}, "center_m"),
        (
            {"boxes": (HAND_BOXES[0], replace(HAND_BOXES[1], center_m=(-0.5, 1.2, -0.5)))},
            "Box 1 and box 2 overlap by",
        ),
        (
            {"boxes": (HAND_BOXES[1], replace(HAND_BOXES[0], number=2))},
            "Box numbers are",
        ),
        (
            {"boxes": (HAND_BOXES[0], replace(HAND_BOXES[1], center_m=(-0.9, 1.2, -0.5)))},
            "not to the right of box 1",
        ),
        ({"target": BlockSpec((-0.2, 1.2, -0.5), (0.1, 0.1, 0.1))}, "Box 2 and the target overlap"),
        ({"target": BlockSpec((0.0, 1.6, -0.5), (0.1, 0.0, 0.1))}, "The target has size_m"),
        ({"sides": (Side.FRONT,)}, "no side 'front'. Valid sides: left, right, top, bottom"),
        ({"sides": (Side.LEFT, Side.LEFT)}, "named twice"),
        ({"sides": (Side.FRONT_RIM,)}, "at least one wall"),
        ({"sides": (Side.TOP, Side.FRONT_RIM), "wall_thickness_m": 0.3}, "overlap|no deeper"),
        ({"start_square": START}, "no walk back"),
    ],
)
def test_impossible_hand_layouts_are_rejected(changes: dict[str, Any], message: str) -> None:
    """An impossible hand layout raises an error that states the value and what to do."""
    with pytest.raises(LayoutError, match=message):
        hand(**changes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"start_square": None}, "no start square"),
        ({"sides": (Side.FRONT_RIM,)}, "no side 'front_rim'"),
        ({"boxes": (replace(FOOT_BOXES[0], center_m=(0.0, 0.05, -0.6)),)}, "below the floor"),
        (
            {"start_square": BlockSpec((0.0, 0.0, -0.3), (0.5, 0.1, 0.5))},
            "the start square overlap",
        ),
    ],
)
def test_impossible_foot_layouts_are_rejected(changes: dict[str, Any], message: str) -> None:
    """A foot layout needs a start square apart from its boxes, and boxes on the floor."""
    with pytest.raises(LayoutError, match=message):
        foot(**changes)
