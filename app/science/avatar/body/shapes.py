"""Define the collision shapes of the body parts: capsules, boxes and spheres.

Thicknesses are those of `app.science.skeleton`. Estimated by us, as the skeleton has none: the
breadths of the trunk (that of the hips is published, .191 of the stature: Winter 2009, figure 4.1),
the thickness of the palm, and the height of foot and toes. The breadth of the foot, .055 of the
stature, is published there too.

A part that a model lacks is rigid: its shapes are added to the part above it. A finger that is
missing as a whole has no shape; a hand without any finger is one flat box as long as the hand.
"""

from dataclasses import dataclass
from math import pi

from app.science.avatar.body.parts import FINGERS, SEGMENTS
from app.science.avatar.body.proportions import Proportions
from app.science.rotations import Vector, v_add, v_length, v_subtract
from app.science.skeleton import HALF_FOOT_BREADTH, TOES_JOINT_HEIGHT

_HALF_BREADTHS = {"Hips": 0.0955, "Spine": 0.082, "Chest": 0.085, "UpperChest": 0.095}
_HALF_PALM, _FOOT_HEIGHT, _TOES_HEIGHT = 0.008, 0.028, 0.020


@dataclass(frozen=True)
class Capsule:
    """A cylinder with hemispherical ends, from start to end; a sphere where the two coincide."""

    start_m: Vector
    end_m: Vector
    radius_m: float

    def moved(self, by: Vector) -> "Capsule":
        """Return the capsule moved by a vector."""
        return Capsule(v_add(self.start_m, by), v_add(self.end_m, by), self.radius_m)

    @property
    def volume_m3(self) -> float:
        """Return the volume of cylinder and caps."""
        return pi * self.radius_m**2 * (self.length_m + 4.0 / 3.0 * self.radius_m)

    @property
    def length_m(self) -> float:
        """Return the length of the axis, without the caps."""
        return v_length(v_subtract(self.end_m, self.start_m))

    @property
    def center_m(self) -> Vector:
        """Return the centre of the capsule."""
        (ax, ay, az), (bx, by, bz) = self.start_m, self.end_m
        return ((ax + bx) / 2, (ay + by) / 2, (az + bz) / 2)


@dataclass(frozen=True)
class Box:
    """A box whose edges are parallel to the axes of its part's frame."""

    center_m: Vector
    half_size_m: Vector

    def moved(self, by: Vector) -> "Box":
        """Return the box moved by a vector."""
        return Box(v_add(self.center_m, by), self.half_size_m)

    @property
    def volume_m3(self) -> float:
        """Return the volume of the box."""
        x, y, z = self.half_size_m
        return 8.0 * x * y * z


Shape = Capsule | Box


def shapes_of(body: Proportions, part: str) -> tuple[Shape, ...]:
    """Return the shapes of one part of a complete body, in the part's frame."""
    base = part.removeprefix("Left").removeprefix("Right")
    if part in _HALF_BREADTHS:
        return (_trunk(body, part),)
    if part == "Head":
        x, y, z = body.ends_m[part]
        middle = (x, y - body.radii_m[part], z)
        return (Capsule(middle, middle, body.radii_m[part]),)
    if base == "Hand":
        return (palm(body, part),)
    if base == "Foot":
        return (_foot(body, part),)
    if base == "Toes":
        return (_toes(body, part),)
    end = _axis_end(body, part) if base.endswith("Distal") else body.ends_m[part]
    return (Capsule((0.0, 0.0, 0.0), end, body.radii_m[part]),)


def palm(body: Proportions, hand: str) -> Box:
    """Return the flat box from the wrist to the knuckles of a hand with fingers."""
    side = hand.removesuffix("Hand")
    index, little = f"{side}IndexProximal", f"{side}LittleProximal"
    front = body.joints_m[index][2] - body.radii_m[index]
    back = body.joints_m[little][2] + body.radii_m[little]
    length = body.ends_m[hand][0]
    half = (abs(length) / 2, _HALF_PALM * body.stature_m, (back - front) / 2)
    return Box((length / 2, 0.0, (front + back) / 2), half)


def mitten(body: Proportions, hand: str) -> Box:
    """Return the box of a hand without fingers: as wide as the palm, as long as the hand."""
    box = palm(body, hand)
    length = body.segments_m["hand"] * (-1.0 if hand.startswith("Left") else 1.0)
    _, half_y, half_z = box.half_size_m
    return Box((length / 2, 0.0, box.center_m[2]), (abs(length) / 2, half_y, half_z))


def fingers_of(hand: str) -> tuple[tuple[str, ...], ...]:
    """Return the five fingers of a hand, each as its parts from the knuckle to the tip."""
    side = hand.removesuffix("Hand")
    return tuple(tuple(f"{side}{finger}{segment}" for segment in SEGMENTS) for finger in FINGERS)


def _trunk(body: Proportions, part: str) -> Capsule:
    # A capsule across the body: as thick as the trunk is deep, as long as it is wide.
    radius = body.radii_m[part]
    half = _HALF_BREADTHS[part] * body.stature_m - radius
    height = body.ends_m[part][1] / 2
    return Capsule((-half, height, 0.0), (half, height, 0.0), radius)


def _axis_end(body: Proportions, part: str) -> Vector:
    """Return the end of a capsule's axis for which the cap ends at the tip of the bone."""
    x, y, z = body.ends_m[part]
    length = v_length((x, y, z))
    factor = max(length - body.radii_m[part], 0.0) / length
    return (x * factor, y * factor, z * factor)


def _foot(body: Proportions, part: str) -> Box:
    toes = body.ends_m[part][2]
    return _block(body, toes, body.heel_m, -body.ankle_height_m, _FOOT_HEIGHT * body.stature_m)


def _toes(body: Proportions, part: str) -> Box:
    sole = -TOES_JOINT_HEIGHT * body.stature_m
    return _block(body, body.ends_m[part][2], 0.0, sole, _TOES_HEIGHT * body.stature_m)


def _block(body: Proportions, front: float, back: float, sole: float, height: float) -> Box:
    half = (HALF_FOOT_BREADTH * body.stature_m, height / 2, (back - front) / 2)
    return Box((0.0, sole + height / 2, (front + back) / 2), half)
