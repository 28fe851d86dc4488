"""Define which body parts collide with each other: the collision layers of the thesis, as data.

Every part belongs to a layer, and a table states which pairs of layers collide. Torso, arms, legs,
shoulders, hands and feet are separate layers (Karas 2020, section 4.2.1): an arm does not collide
with torso and shoulders, so it can be moved across the upper body, while a hand still touches the
arms and the upper body. Parts of one layer never collide. The thesis's matrix is a picture we do
not have; where its text leaves it open, these rules are ours: left and right arm collide, a hand
touches the legs, a foot touches the other leg and foot, and the two thighs, which nearly touch when
people stand, pass through each other.

Everything collides with the scene.

For MuJoCo a layer is a bit. Two shapes collide when the `contype` of one shares a bit with the
`conaffinity` of the other. Connected bodies overlap at their joint: MuJoCo ignores contacts between
parent and child, but not those of a hand and its fingers with their own forearm, which
`excluded_pairs` lists.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from types import MappingProxyType

from app.science.avatar.body.parts import FINGERS, PART_NAMES, SIDES

LAYERS: tuple[str, ...] = (
    "torso", "shoulders", "left_arm", "right_arm", "left_leg", "right_leg",
    "left_hand", "right_hand", "left_foot", "right_foot",
)  # fmt: skip
SCENE_BIT = 1
"""Bit for collisions with the scene; geoms of the scene have it as `conaffinity`."""


def _layer(part: str) -> str:
    side = next((side for side in SIDES if part.startswith(side)), None)
    if side is None:
        return "torso"
    base = part.removeprefix(side)
    if base == "Shoulder":
        return "shoulders"
    kind = {
        "UpperArm": "arm", "LowerArm": "arm", "UpperLeg": "leg", "LowerLeg": "leg",
        "Foot": "foot", "Toes": "foot",
    }.get(base, "hand")  # fmt: skip
    return f"{side.lower()}_{kind}"


LAYER_OF: Mapping[str, str] = MappingProxyType({part: _layer(part) for part in PART_NAMES})
"""Collision layer of each part."""


def _colliding() -> Iterator[frozenset[str]]:
    for side, other in (("left", "right"), ("right", "left")):
        for layer in LAYERS:
            if not layer.endswith("hand") or layer.startswith(other):
                yield frozenset((f"{side}_hand", layer))
        yield frozenset((f"{side}_foot", f"{other}_leg"))
    yield frozenset(("left_arm", "right_arm"))
    yield frozenset(("left_foot", "right_foot"))


COLLIDING: frozenset[frozenset[str]] = frozenset(_colliding())
"""The pairs of layers that collide, unless a running model is told otherwise."""

SWITCHABLE_LAYERS: frozenset[frozenset[str]] = frozenset(
    frozenset(pair)
    for pair in combinations(LAYERS, 2)
    if not ("torso" in pair and pair[1].endswith("_leg"))
)
"""The pairs of layers whose collisions can be switched while a model runs.

The thighs overlap the trunk when somebody sits or bends down, so they cannot be made to collide.
"""


@dataclass(frozen=True)
class CollisionBits:
    """MuJoCo's two collision masks of a shape."""

    contype: int
    conaffinity: int


NO_COLLISION = CollisionBits(0, 0)
SCENE = CollisionBits(0, SCENE_BIT)


def collision_bits(
    part: str, *, self_collision: bool, colliding: Collection[frozenset[str]] = COLLIDING
) -> CollisionBits:
    """Return the masks of a body part's shapes; they can also be set in a running model.

    Args:
        part: the body part.
        self_collision: whether it collides with other body parts.
        colliding: the pairs of layers that collide.
    """
    layer = LAYER_OF[part]
    if not self_collision:
        return CollisionBits(SCENE_BIT, 0)
    partners = sum(layer_bit(other) for other in LAYERS if frozenset((layer, other)) in colliding)
    return CollisionBits(SCENE_BIT | layer_bit(layer), partners)


def collide(part: str, other: str) -> bool:
    """Return whether the layers of two body parts collide.

    Parts that are attached to each other never collide, whatever their layers (`excluded_pairs`).
    """
    return frozenset((LAYER_OF[part], LAYER_OF[other])) in COLLIDING


def excluded_pairs(
    parents: Mapping[str, str | None], colliding: Collection[frozenset[str]] = COLLIDING
) -> Iterator[tuple[str, str]]:
    """Yield the pairs of present parts that never collide although their layers do.

    These are parent and child, and a hand with its fingers against its own forearm.

    Args:
        parents: present part -> the present part it is attached to.
        colliding: the pairs of layers that collide in the configuration.
    """
    listed: set[tuple[str, str]] = set()
    for part, parent in parents.items():
        if parent is None:
            continue
        if collide(part, parent) or frozenset((LAYER_OF[part], LAYER_OF[parent])) in colliding:
            listed.add((parent, part))
            yield parent, part
    for side in SIDES:
        forearm = f"{side}LowerArm"
        for part in _hand(side, parents):
            if forearm in parents and (forearm, part) not in listed:
                yield forearm, part


def _hand(side: str, present: Collection[str]) -> Iterator[str]:
    starts = (f"{side}Hand", *(f"{side}{finger}" for finger in FINGERS))
    return (part for part in present if part.startswith(starts))


def layer_bit(layer: str) -> int:
    """Return the bit of a layer in both of MuJoCo's collision masks."""
    return SCENE_BIT << (1 + LAYERS.index(layer))
