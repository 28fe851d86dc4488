"""Which body parts collide with each other: the collision layers of the thesis, as data.

Every part belongs to a layer, and two layers collide or do not. Torso, arms, legs, shoulders,
hands and feet are layers of their own (Karas 2020, section 4.2.1): an arm does not collide with
torso and shoulders, so it can be moved across the upper body, while a hand still touches the arms
and the upper body. Parts of one layer never collide. The thesis's matrix is a picture we do not
have; where its words leave it open, what follows is ours: left and right arm collide, a hand
touches the legs, a foot the other leg and foot, and the two thighs, which nearly touch when people
stand, pass through each other.

Everything collides with the scene.

For MuJoCo a layer is a bit. Two shapes collide when the `contype` of one meets the `conaffinity` of
the other. Bodies that hang on each other overlap at the joint: MuJoCo leaves neighbours out by
itself, but not a hand and its fingers against their own forearm, which `excluded_pairs` names.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.science.avatar.body.parts import FINGERS, PART_NAMES, SIDES

LAYERS: tuple[str, ...] = (
    "torso", "shoulders", "left_arm", "right_arm", "left_leg", "right_leg",
    "left_hand", "right_hand", "left_foot", "right_foot",
)  # fmt: skip
SCENE_BIT = 1
"""Bit of everything that is not a body; scene geoms have it as `conaffinity`."""


def _layer(part: str) -> str:
    side = next((side for side in SIDES if part.startswith(side)), None)
    if side is None:
        return "torso"
    bare = part.removeprefix(side)
    if bare == "Shoulder":
        return "shoulders"
    kind = {
        "UpperArm": "arm", "LowerArm": "arm", "UpperLeg": "leg", "LowerLeg": "leg",
        "Foot": "foot", "Toes": "foot",
    }.get(bare, "hand")  # fmt: skip
    return f"{side.lower()}_{kind}"


LAYER_OF: Mapping[str, str] = MappingProxyType({part: _layer(part) for part in PART_NAMES})
"""Part -> its layer."""


def _colliding() -> Iterator[frozenset[str]]:
    for side, other in (("left", "right"), ("right", "left")):
        for layer in LAYERS:
            if not layer.endswith("hand") or layer.startswith(other):
                yield frozenset((f"{side}_hand", layer))
        yield frozenset((f"{side}_foot", f"{other}_leg"))
    yield frozenset(("left_arm", "right_arm"))
    yield frozenset(("left_foot", "right_foot"))


COLLIDING: frozenset[frozenset[str]] = frozenset(_colliding())
"""The pairs of layers that collide."""


@dataclass(frozen=True)
class CollisionBits:
    """MuJoCo's two masks of a shape."""

    contype: int
    conaffinity: int


NO_COLLISION = CollisionBits(0, 0)
SCENE = CollisionBits(0, SCENE_BIT)


def collision_bits(part: str, *, self_collision: bool) -> CollisionBits:
    """Return the masks of a body part's shapes; also good for switching a running model."""
    layer = LAYER_OF[part]
    if not self_collision:
        return CollisionBits(SCENE_BIT, 0)
    partners = sum(_bit(other) for other in LAYERS if frozenset((layer, other)) in COLLIDING)
    return CollisionBits(SCENE_BIT | _bit(layer), partners)


def collide(part: str, other: str) -> bool:
    """Whether the layers of two body parts collide; neighbours still never do."""
    return frozenset((LAYER_OF[part], LAYER_OF[other])) in COLLIDING


def excluded_pairs(parents: Mapping[str, str | None]) -> Iterator[tuple[str, str]]:
    """Pairs of present parts that never collide although their layers do: parent and child, and
    a hand with its fingers against the forearm it hangs on.

    Args:
        parents: present part -> the present part it hangs on.
    """
    seen: set[tuple[str, str]] = set()
    for part, parent in parents.items():
        if parent is not None and collide(part, parent):
            seen.add((parent, part))
            yield parent, part
    for side in SIDES:
        forearm = f"{side}LowerArm"
        for part in _hand(side, parents):
            if forearm in parents and (forearm, part) not in seen:
                yield forearm, part


def _hand(side: str, present: Collection[str]) -> Iterator[str]:
    starts = (f"{side}Hand", *(f"{side}{finger}" for finger in FINGERS))
    return (part for part in present if part.startswith(starts))


def _bit(layer: str) -> int:
    return SCENE_BIT << (1 + LAYERS.index(layer))
