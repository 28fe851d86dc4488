"""Validate the boxes of a task; every error names the value and the remedy."""

import math
from itertools import combinations, pairwise

from app.science.tasks.names import Limb
from app.science.tasks.surfaces import BlockSpec, BoxSpec, LayoutError, Vector3

_Extent = tuple[str, Vector3, Vector3]

# Boxes may share a face; rounding of their centres must not turn that into an overlap.
_TOUCHING_M = 1e-9


def check_positive(name: str, value: float) -> None:
    """Raise LayoutError unless the length is a positive, finite number of metres."""
    if not (math.isfinite(value) and value > 0):
        raise LayoutError(f"{name} is {value}. Give a positive length in metres.")


def check_layout(
    limb: Limb,
    boxes: tuple[BoxSpec, ...],
    target: BlockSpec,
    start_square: BlockSpec | None,
    wall_m: float,
    panel_m: float,
) -> None:
    """Raise LayoutError for a layout that cannot be displayed or used; metres, world frame."""
    _check_numbers(boxes)
    _check_start(limb, start_square)
    for box in boxes:
        _check_vectors(f"Box {box.number}", box.center_m, box.inner_size_m, "inner_size_m")
    _check_vectors("The target", target.center_m, target.size_m, "size_m")
    extents = [_outer(limb, box, wall_m, panel_m) for box in boxes]
    extents.append(_extent("the target", target))
    if start_square is not None:
        _check_vectors("The start square", start_square.center_m, start_square.size_m, "size_m")
        extents.append(_extent("the start square", start_square))
    if limb is Limb.FOOT:
        _check_floor(boxes)
    _check_order(boxes)
    _check_apart(extents)


def _check_numbers(boxes: tuple[BoxSpec, ...]) -> None:
    numbers = [box.number for box in boxes]
    if not boxes or numbers != list(range(1, len(boxes) + 1)):
        raise LayoutError(
            f"Box numbers are {numbers}. Number the boxes 1, 2, ... n from left to right, in order."
        )


def _check_start(limb: Limb, start_square: BlockSpec | None) -> None:
    if limb is Limb.FOOT and start_square is None:
        raise LayoutError("A foot task has no start square. Give one: the walk back ends on it.")
    if limb is Limb.HAND and start_square is not None:
        raise LayoutError("A hand task has a start square, but no walk back. Leave it out.")


def _check_vectors(name: str, center_m: Vector3, size_m: Vector3, size_name: str) -> None:
    if not all(math.isfinite(value) for value in center_m):
        raise LayoutError(f"{name} has center_m {center_m}. Give three finite numbers in metres.")
    for value in size_m:
        if not (math.isfinite(value) and value > 0):
            raise LayoutError(
                f"{name} has {size_name} {size_m}. Give three positive lengths in metres."
            )


def _check_floor(boxes: tuple[BoxSpec, ...]) -> None:
    for box in boxes:
        bottom_m = box.center_m[1] - box.inner_size_m[1] / 2
        if bottom_m < -_TOUCHING_M:
            raise LayoutError(
                f"Foot box {box.number} starts {-bottom_m:.3f} m below the floor (y = 0). "
                f"Raise its centre to at least {box.inner_size_m[1] / 2} m."
            )


def _check_order(boxes: tuple[BoxSpec, ...]) -> None:
    for left, right in pairwise(boxes):
        if left.center_m[0] >= right.center_m[0]:
            raise LayoutError(
                f"Box {right.number} (x = {right.center_m[0]} m) is not to the right of box "
                f"{left.number} (x = {left.center_m[0]} m). Number the boxes from left to right."
            )


def _check_apart(extents: list[_Extent]) -> None:
    for (name, low, high), (other, other_low, other_high) in combinations(extents, 2):
        depths = [
            min(high[axis], other_high[axis]) - max(low[axis], other_low[axis]) for axis in range(3)
        ]
        if min(depths) > _TOUCHING_M:
            raise LayoutError(
                f"{name.capitalize()} and {other} overlap by {min(depths):.3f} m. "
                "Move them apart or make them (or the walls) smaller."
            )


def _extent(name: str, block: BlockSpec) -> _Extent:
    low = [c - s / 2 for c, s in zip(block.center_m, block.size_m, strict=True)]
    high = [c + s / 2 for c, s in zip(block.center_m, block.size_m, strict=True)]
    return name, (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _outer(limb: Limb, box: BoxSpec, wall_m: float, panel_m: float) -> _Extent:
    """Return the extent of a box with its walls and panel, at least as large as what is built."""
    _, low, high = _extent("", BlockSpec(box.center_m, box.inner_size_m))
    depth = 2 if limb is Limb.HAND else 1
    grown_low = [low[a] - (panel_m if a == depth else wall_m) for a in range(3)]
    grown_high = [high[a] + (0.0 if a == depth else wall_m) for a in range(3)]
    return (
        f"box {box.number}",
        (grown_low[0], grown_low[1], grown_low[2]),
        (grown_high[0], grown_high[1], grown_high[2]),
    )
