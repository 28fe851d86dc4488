"""Derive the simulated participant's goal from the surface that the task rules expect next."""

from app.science.simulation import Goal, GoalKind
from app.science.tasks import (
    Laterality,
    Limb,
    Surface,
    SurfaceKind,
    TaskState,
    Vector3,
    current_goal,
)

_WAY_OUT_M = 0.12
_STEP_CLEARANCE_M = 0.08
_HALF_HAND_M = 0.05


def goal_of(state: TaskState, leading_foot: Laterality, *, solid: bool = False) -> Goal | None:
    """Return the goal in the current state; None once the phase is frozen.

    `solid`: the avatar cannot pass through the boxes, so the hand is aimed to fit between walls.
    """
    key = current_goal(state)
    if key is None:
        return None
    layout = state.rules.layout
    surface = layout.by_key[key]
    if layout.limb is Limb.HAND:
        return _reach(surface, state, _HALF_HAND_M if solid else 0.0)
    if surface.kind is SurfaceKind.START:
        return Goal(
            GoalKind.WALK_TO, None, _on_floor(surface), 0.1, (0.0, _edge_height(state), 0.0)
        )
    return _step(surface, state, leading_foot)


def _reach(surface: Surface, state: TaskState, half_hand_m: float) -> Goal:
    x, y, z = surface.center_m
    half_depth = surface.half_size_m[2]
    out_m = _box_depth(surface, state) + _WAY_OUT_M
    return Goal(
        GoalKind.REACH,
        f"{state.rules.writing_hand.value.capitalize()}Hand",
        # The centre of the face towards the participant.
        (x, y, z + half_depth),
        max(0.02, min(surface.half_size_m[0], surface.half_size_m[1]) - half_hand_m),
        (0.0, 0.0, out_m),
    )


def _step(surface: Surface, state: TaskState, leading_foot: Laterality) -> Goal:
    # The feet alternate from box to box, as in walking.
    other = Laterality.LEFT if leading_foot is Laterality.RIGHT else Laterality.RIGHT
    counting = state.rules.layout.counting_foot
    foot = counting or (leading_foot if state.n_green % 2 == 0 else other)
    x, y, z = surface.center_m
    return Goal(
        GoalKind.STEP,
        f"{foot.value.capitalize()}Foot",
        (x, y + surface.half_size_m[1], z),
        max(0.03, surface.half_size_m[0] * 0.6),
        (0.0, _edge_height(state), 0.0),
    )


def _box_depth(surface: Surface, state: TaskState) -> float:
    """Return how far the box's walls protrude in front of its panel."""
    sides = [
        one
        for one in state.rules.layout.surfaces
        if one.kind is SurfaceKind.SIDE and one.box == surface.box
    ]
    return max((2 * one.half_size_m[2] for one in sides), default=0.0)


def _edge_height(state: TaskState) -> float:
    """Return a height that clears every edge of the foot boxes."""
    tops = [
        one.center_m[1] + one.half_size_m[1]
        for one in state.rules.layout.surfaces
        if one.kind is SurfaceKind.SIDE
    ]
    return max(tops, default=0.0) + _STEP_CLEARANCE_M


def _on_floor(surface: Surface) -> Vector3:
    x, _, z = surface.center_m
    return (x, 0.0, z)
