"""Define the 52 body parts, how they are connected, and the axes about which each can turn.

Names are Unity's HumanBodyBones. Every part is a rigid body; its frame has its origin in its joint
and is parallel to the world in the T-pose (x right, y up, facing -z), so the left arm points along
-x.

An axis is named after the part and the world's axis it lies along in the T-pose: `LeftUpperLegX`.
Its direction is chosen so that a positive angle is the movement that `movement` names, on both
sides: the right side's axes are the left side's mirrored at the body's median plane, (x, -y, -z). A
part's rotation is the product of its axes' rotations in the order they are listed,

    parent_from_part = R(axis 1, angle 1) R(axis 2, angle 2) R(axis 3, angle 3),

which is how a chain of hinges turns: the first hinge carries the others.

Degrees of freedom: the hips have 3 of translation and 3 of rotation (bound to the participant, not
driven); the three joints of the spine, neck and head have 3 each, shoulders none; an arm has 29
(upper arm, forearm and hand 3 each, five fingers 2, 1 and 1 by segment), a leg 9 (thigh 3, knee 2,
foot 3, toes 1). Without the hips 91 axes are driven.

Source: Karas (2020), section 3.2. The directions and their order are ours.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from app.science.rotations import Vector
from app.science.skeleton import FINGER_PARTS as FINGER_PARTS
from app.science.skeleton import FINGERS as FINGERS
from app.science.skeleton import SEGMENTS as SEGMENTS

Letter = Literal["X", "Y", "Z"]
SIDES = ("Left", "Right")


@dataclass(frozen=True)
class Axis:
    """One hinge of a part.

    Attributes:
        part: HumanBodyBones name.
        letter: the world's axis it lies along in the T-pose; only approximately for oblique
            fingers.
        direction: unit vector in the part's frame.
        movement: the movement that a positive angle causes.
    """

    part: str
    letter: Letter
    direction: Vector
    movement: str

    @property
    def name(self) -> str:
        """Return the name of the axis and of its motor, such as `LeftUpperLegX`."""
        return f"{self.part}{self.letter}"


def _arm_tree(side: str) -> Iterator[tuple[str, str]]:
    yield f"{side}Shoulder", "UpperChest"
    yield f"{side}UpperArm", f"{side}Shoulder"
    yield f"{side}LowerArm", f"{side}UpperArm"
    yield f"{side}Hand", f"{side}LowerArm"
    for finger in FINGERS:
        above = f"{side}Hand"
        for segment in SEGMENTS:
            part = f"{side}{finger}{segment}"
            yield part, above
            above = part


def _leg_tree(side: str) -> Iterator[tuple[str, str]]:
    above = "Hips"
    for part in ("UpperLeg", "LowerLeg", "Foot", "Toes"):
        yield f"{side}{part}", above
        above = f"{side}{part}"


def _tree() -> Iterator[tuple[str, str | None]]:
    yield "Hips", None
    above = "Hips"
    for part in ("Spine", "Chest", "UpperChest", "Neck", "Head"):
        yield part, above
        above = part
    for side in SIDES:
        yield from _arm_tree(side)
    for side in SIDES:
        yield from _leg_tree(side)


PARENT_OF: Mapping[str, str | None] = MappingProxyType(dict(_tree()))
"""Each part's parent; a parent comes before its children."""
PART_NAMES: tuple[str, ...] = tuple(PARENT_OF)

_RIGHT, _UP, _BACK = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_LEFT, _DOWN, _FORWARD = (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)
_AxisRow = tuple[Letter, Vector, str]
_TRUNK: tuple[_AxisRow, ...] = (
    ("X", _LEFT, "bend forward"),
    ("Z", _BACK, "bend to the left"),
    ("Y", _UP, "turn to the left"),
)
# Three axes come close to gimbal lock where the second is near 90 degrees: first and third are
# aligned, and tiny movements turn both far. With Y, Z, X, arms hanging at the sides are there:
# in four walks, up to all frames were within 10 degrees of it, and angles moved at up to 280 rad/s.
# With Z, X, Y no frame is, at 8 rad/s at most (CMU 02_01, 02_06, 06_01, 12_02). Z, Y, X works
# as well there, but locks where arms point forward, as in reaching. The hand's turn comes first, so
# that it lies along the forearm's own, which can take over what the wrist cannot do.
# Axes of the left side. A thumb lies in front of the palm and closes towards the little finger.
_LIMBS: Mapping[str, tuple[_AxisRow, ...]] = {
    "UpperArm": (
        ("Z", _FORWARD, "raise"),
        ("X", _LEFT, "turn inwards"),
        ("Y", _DOWN, "swing forward"),
    ),
    "LowerArm": (
        ("Y", _DOWN, "bend"),
        ("Z", _FORWARD, "carry outwards (not anatomic)"),
        ("X", _LEFT, "pronate"),
    ),
    "Hand": (
        ("X", _LEFT, "turn inwards"),
        ("Y", _DOWN, "deviate to the thumb"),
        ("Z", _BACK, "bend to the palm"),
    ),
    "UpperLeg": (
        ("X", _RIGHT, "lift forward"),
        ("Z", _FORWARD, "spread outwards"),
        ("Y", _DOWN, "turn inwards"),
    ),
    "LowerLeg": (("X", _LEFT, "bend"), ("Y", _DOWN, "turn inwards")),
    "Foot": (
        ("X", _RIGHT, "lift the toes"),
        ("Z", _FORWARD, "raise the inner edge"),
        ("Y", _DOWN, "turn inwards"),
    ),
    "Toes": (("X", _RIGHT, "lift"),),
}
_FINGER_BEND: _AxisRow = ("Z", _BACK, "bend")
_FINGER_SPREAD: _AxisRow = ("Y", _DOWN, "spread to the thumb")
_THUMB_BEND: _AxisRow = ("Y", _UP, "bend across the palm")
_THUMB_SPREAD: _AxisRow = ("Z", _BACK, "lower to the palm")


def _rows(part: str) -> tuple[_AxisRow, ...]:
    if part in {"Spine", "Chest", "UpperChest", "Neck", "Head"}:
        return _TRUNK
    base = part.removeprefix("Left").removeprefix("Right")
    if base.startswith("Thumb"):
        return (_THUMB_BEND, _THUMB_SPREAD) if base.endswith("Proximal") else (_THUMB_BEND,)
    if base.endswith("Proximal"):
        return (_FINGER_BEND, _FINGER_SPREAD)
    if base.endswith(("Intermediate", "Distal")):
        return (_FINGER_BEND,)
    return _LIMBS.get(base, ())


def _axes(part: str) -> tuple[Axis, ...]:
    mirrored = part.startswith("Right")
    return tuple(
        Axis(part, letter, (x, -y, -z) if mirrored else (x, y, z), movement)
        for letter, (x, y, z), movement in _rows(part)
    )


AXES_OF: Mapping[str, tuple[Axis, ...]] = MappingProxyType(
    {part: _axes(part) for part in PART_NAMES}
)
"""The driven axes of each part, outermost first; none for the hips and the shoulders."""
AXES: tuple[Axis, ...] = tuple(axis for part in PART_NAMES for axis in AXES_OF[part])
AXIS_NAMES: tuple[str, ...] = tuple(axis.name for axis in AXES)


def mirrored_name(name: str) -> str:
    """Return the name of the same part or axis on the other side.

    The name of a part or axis of the trunk or head is returned unchanged.
    """
    if name.startswith("Left"):
        return f"Right{name.removeprefix('Left')}"
    return f"Left{name.removeprefix('Right')}" if name.startswith("Right") else name
