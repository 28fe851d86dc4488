"""Compute the surfaces of a task from its box specifications.

Hand boxes open towards the participant (+z) and have their panel at the far end (-z); foot boxes
open at the top and have their panel on the floor. So the two limbs differ only in which world axis
is the depth and which walls surround it, and the same code builds both.
"""

from dataclasses import dataclass

from app.science.tasks.names import Direction, Laterality, Limb, Side, SurfaceKind
from app.science.tasks.surfaces import (
    BlockSpec,
    BoxSpec,
    LayoutError,
    Surface,
    TaskLayout,
    Vector3,
)
from app.science.tasks.validation import check_layout, check_positive

__all__ = [
    "BlockSpec",
    "BoxSpec",
    "Direction",
    "Laterality",
    "LayoutError",
    "Limb",
    "Side",
    "Surface",
    "SurfaceKind",
    "TaskLayout",
    "Vector3",
    "build_layout",
]


@dataclass(frozen=True)
class _Frame:
    """The walls of a limb's boxes, as side -> (world axis, sign), and their axis of depth."""

    walls: dict[Side, tuple[int, int]]
    depth: int


_FRAMES = {
    Limb.HAND: _Frame(
        {Side.LEFT: (0, -1), Side.RIGHT: (0, 1), Side.TOP: (1, 1), Side.BOTTOM: (1, -1)}, depth=2
    ),
    Limb.FOOT: _Frame(
        {Side.LEFT: (0, -1), Side.RIGHT: (0, 1), Side.FRONT: (2, 1), Side.BACK: (2, -1)}, depth=1
    ),
}


def build_layout(
    limb: Limb,
    boxes: tuple[BoxSpec, ...],
    target: BlockSpec,
    *,
    wall_thickness_m: float,
    panel_thickness_m: float,
    reverse_after_task: bool,
    start_square: BlockSpec | None = None,
    sides: tuple[Side, ...] | None = None,
    counting_foot: Laterality | None = None,
    direction: Direction = Direction.BY_HAND,
) -> TaskLayout:
    """Build the surfaces of a task, in a fixed order: box by box (panel, sides), target, start.

    Walls and panel lie outside the cavity and do not overlap each other. Walls extend over the edge
    of the panel, so a panel is touched from inside its box. With `Side.FRONT_RIM` (hand only) the
    last `wall_thickness_m` of each wall before the opening become rim bars, which together form one
    side.

    `sides`: None means all four walls and no rim. `start_square`: required for feet (the walk back
    ends there), not allowed for hands. `counting_foot`: None lets either foot count.

    Raises LayoutError for sizes that are not positive, numbers that are not 1..n left to right,
    sides the limb does not have, overlapping boxes or blocks, and a foot box below the floor.
    """
    check_positive("wall_thickness_m", wall_thickness_m)
    check_positive("panel_thickness_m", panel_thickness_m)
    chosen = tuple(_FRAMES[limb].walls) if sides is None else sides
    _check_sides(limb, chosen)
    check_layout(limb, boxes, target, start_square, wall_thickness_m, panel_thickness_m)
    surfaces: list[Surface] = []
    for box in boxes:
        if Side.FRONT_RIM in chosen and box.inner_size_m[2] <= wall_thickness_m:
            raise LayoutError(
                f"Box {box.number} is {box.inner_size_m[2]} m deep, no deeper than its front rim "
                f"({wall_thickness_m} m). Make the box deeper or leave the front rim out."
            )
        surfaces += _box_surfaces(limb, box, chosen, wall_thickness_m, panel_thickness_m)
    surfaces.append(_block(f"{limb}/target", SurfaceKind.TARGET, target))
    if start_square is not None:
        surfaces.append(_block(f"{limb}/start", SurfaceKind.START, start_square))
    return TaskLayout(limb, tuple(surfaces), reverse_after_task, counting_foot, direction)


def _check_sides(limb: Limb, sides: tuple[Side, ...]) -> None:
    """Raise LayoutError for unknown or duplicate sides, and for a rim without walls."""
    walls = tuple(_FRAMES[limb].walls)
    valid = (*walls, Side.FRONT_RIM) if limb is Limb.HAND else walls
    names = ", ".join(valid)
    for side in sides:
        if side not in valid:
            raise LayoutError(f"A {limb} box has no side {side.value!r}. Valid sides: {names}.")
    if len(set(sides)) != len(sides):
        given = ", ".join(sides)
        raise LayoutError(f"Sides are named twice: {given}. Name each of {names} at most once.")
    if Side.FRONT_RIM in sides and not set(sides) & set(walls):
        raise LayoutError("A front rim needs at least one wall to sit on. Add a wall to the sides.")


def _block(key: str, kind: SurfaceKind, spec: BlockSpec) -> Surface:
    x, y, z = spec.size_m
    return Surface(key, kind, None, None, spec.center_m, (x / 2, y / 2, z / 2))


def _box_surfaces(
    limb: Limb, box: BoxSpec, sides: tuple[Side, ...], wall_m: float, panel_m: float
) -> list[Surface]:
    """Return panel, walls and rim bars of one box."""
    frame = _FRAMES[limb]
    low = [c - s / 2 for c, s in zip(box.center_m, box.inner_size_m, strict=True)]
    high = [c + s / 2 for c, s in zip(box.center_m, box.inner_size_m, strict=True)]
    depth, name = frame.depth, f"{limb}/{box.number}"
    walls = [side for side in frame.walls if side in sides]
    surfaces = [
        _surface(
            f"{name}/panel", SurfaceKind.PANEL, box.number, None,
            _with(low, depth, low[depth] - panel_m), _with(high, depth, low[depth]),
        )
    ]  # fmt: skip
    rim_m = wall_m if Side.FRONT_RIM in sides else 0.0
    for side in walls:
        wall_low, wall_high = _wall(frame, side, walls, low, high, wall_m)
        back = _with(wall_low, depth, low[depth] - panel_m)
        edge = high[depth] - rim_m
        wall = back, _with(wall_high, depth, edge)
        surfaces.append(_surface(f"{name}/{side}", SurfaceKind.SIDE, box.number, side, *wall))
        if rim_m:
            bar = _with(wall_low, depth, edge), wall_high
            key, rim = f"{name}/{Side.FRONT_RIM}/{side}", Side.FRONT_RIM
            surfaces.append(_surface(key, SurfaceKind.SIDE, box.number, rim, *bar))
    return surfaces


def _wall(
    frame: _Frame, side: Side, walls: list[Side], low: list[float], high: list[float], wall_m: float
) -> tuple[list[float], list[float]]:
    """Return the corners of a wall; left and right walls also cover the ends of the others."""
    axis, sign = frame.walls[side]
    wall_low, wall_high = list(low), list(high)
    wall_low[axis], wall_high[axis] = (
        (low[axis] - wall_m, low[axis]) if sign < 0 else (high[axis], high[axis] + wall_m)
    )
    if axis == 0:
        for other in walls:
            across, direction = frame.walls[other]
            if across != 0 and direction < 0:
                wall_low[across] -= wall_m
            elif across != 0:
                wall_high[across] += wall_m
    return wall_low, wall_high


def _with(values: list[float], axis: int, value: float) -> list[float]:
    return [value if index == axis else old for index, old in enumerate(values)]


def _surface(
    key: str,
    kind: SurfaceKind,
    box: int | None,
    side: Side | None,
    low: list[float],
    high: list[float],
) -> Surface:
    center = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    half = tuple((b - a) / 2 for a, b in zip(low, high, strict=True))
    return Surface(key, kind, box, side, _vector(center), _vector(half))


def _vector(values: tuple[float, ...]) -> Vector3:
    x, y, z = values
    return (x, y, z)
