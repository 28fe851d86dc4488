"""Build the skeleton of one person from the stature, and the arms where they were measured.

Rest pose: the T-pose, every local rotation the identity, world axes x right, y up, -z forward, so
the left arm runs along -x and the feet point to -z. Lengths are fractions of the stature H.

Published (Drillis and Contini 1966 as drawn in Winter 2009, "Biomechanics and Motor Control of
Human Movement", figure 4.1): heights of the ankle .039, knee .285, hip .530, shoulder .818; half
shoulder breadth .129; upper arm .186, forearm .146, hand .108; foot length .152.

Estimated by us, as the figure has no such landmark: the hips joint .015 above the hip sockets and
the sockets .050 to each side (the figure's .0955 is half the outer hip breadth); heights of Spine
.585, Chest .655, UpperChest .725, Neck .835, Head .875; the inner end of the collar bone .020 to
the side at .810; the toe joint .072 in front of the ankle at height .014, a quarter of the foot
behind the ankle; all radii. They determine capsules and the look of the figure; no published number
of ours depends on them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from app.science.rotations import FloatArray
from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES, PARENTS

_LOWEST_STATURE_M, _HIGHEST_STATURE_M = 0.5, 2.6
_LEAST_STRETCH, _MOST_STRETCH = 0.3, 3.0
_MEASURED = {"upper_arm": ("UpperArm", "LowerArm"), "forearm": ("LowerArm", "Hand")}
"""Whose bone a measured segment is, and the joint at which it ends."""
NOTHING_MEASURED: Mapping[str, float] = MappingProxyType({})

# Joint positions in the T-pose as fractions of the stature, (x right, y up, z back), right side.
_CENTRE = {
    "Hips": (0.0, 0.545, 0.0),
    "Spine": (0.0, 0.585, 0.0),
    "Chest": (0.0, 0.655, 0.0),
    "UpperChest": (0.0, 0.725, 0.0),
    "Neck": (0.0, 0.835, 0.0),
    "Head": (0.0, 0.875, 0.0),
}
_RIGHT = {
    "Shoulder": (0.020, 0.810, 0.0),
    "UpperArm": (0.129, 0.818, 0.0),
    "LowerArm": (0.315, 0.818, 0.0),
    "Hand": (0.461, 0.818, 0.0),
    "UpperLeg": (0.050, 0.530, 0.0),
    "LowerLeg": (0.050, 0.285, 0.0),
    "Foot": (0.050, 0.039, 0.0),
    "Toes": (0.050, 0.014, -0.072),
}
_HAND_LENGTH, _TOE_TIP, _HEAD_TOP = 0.108, (0.0, 0.0, -0.042), 0.125
_SEGMENT_END_AT = {
    "Hips": "Spine",
    "Spine": "Chest",
    "Chest": "UpperChest",
    "UpperChest": "Neck",
    "Neck": "Head",
    "Shoulder": "UpperArm",
    "UpperArm": "LowerArm",
    "LowerArm": "Hand",
    "UpperLeg": "LowerLeg",
    "LowerLeg": "Foot",
    "Foot": "Toes",
}
_RADIUS = {
    "Hips": 0.080,
    "Spine": 0.075,
    "Chest": 0.075,
    "UpperChest": 0.075,
    "Neck": 0.033,
    "Head": _HEAD_TOP / 2,
    "Shoulder": 0.033,
    "UpperArm": 0.027,
    "LowerArm": 0.022,
    "Hand": 0.018,
    "UpperLeg": 0.048,
    "LowerLeg": 0.032,
    "Foot": 0.014,
    "Toes": 0.014,
}


class SkeletonError(ValueError):
    """A skeleton or pose is invalid: stature out of range, or arrays of a wrong shape."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Bone lengths and body-part shapes of one person.

    Attributes:
        stature_m: body height.
        offsets_m: (22, 3) joint position in its parent's frame; the hips' row is their position in
            the T-pose above the floor.
        ends_m: (22, 3) anatomical end of each joint's bone in the joint's frame: the next joint,
            the tip of the middle finger, the top of the head, the tip of the toes.
        capsule_starts_m: (22, 3) start of the axis of each body part's capsule in its frame.
        capsule_ends_m: (22, 3) end of that axis; the same as the start for the head, which is a
            sphere, and shortened by the radius at free ends.
        radii_m: (22,) capsule radii.
    """

    names: ClassVar[tuple[str, ...]] = JOINT_NAMES
    parents: ClassVar[tuple[int, ...]] = PARENTS

    stature_m: float
    offsets_m: FloatArray
    ends_m: FloatArray
    capsule_starts_m: FloatArray
    capsule_ends_m: FloatArray
    radii_m: FloatArray

    @property
    def leg_length_m(self) -> float:
        """Return the length of thigh plus shank."""
        return self.length_m("LeftLowerLeg") + self.length_m("LeftFoot")

    @property
    def ankle_height_m(self) -> float:
        """Return the height of the ankle joint above the sole of a flat foot."""
        return 0.039 * self.stature_m

    @property
    def standing_hips_m(self) -> float:
        """Return the height of the hips joint above the floor with straight legs."""
        return float(self.offsets_m[0, 1])

    def length_m(self, joint: str) -> float:
        """Return the length of the bone that ends at this joint."""
        return float(np.linalg.norm(self.offsets_m[JOINT_INDEX[joint]]))


def build_skeleton(
    stature_m: float, segments_m: Mapping[str, float] = NOTHING_MEASURED
) -> Skeleton:
    """Build the skeleton of a person of this stature.

    Args:
        stature_m: body height.
        segments_m: measured lengths of both sides by the names of an avatar's segments; upper_arm
            and forearm are used, other bones are fractions of the stature.

    Raises:
        SkeletonError: the stature is not between 0.5 and 2.6 m (a value in cm is the usual cause),
            or an arm is not between 0.3 and 3 times as long as usual.
    """
    if not _LOWEST_STATURE_M <= stature_m <= _HIGHEST_STATURE_M:
        raise SkeletonError(
            f"A stature of {stature_m} m is outside {_LOWEST_STATURE_M} to {_HIGHEST_STATURE_M} m:"
            " give the body height in metres."
        )
    places = np.array([_rest_position(name) for name in JOINT_NAMES])
    offsets, ends = places.copy(), np.zeros((JOINT_COUNT, 3))
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            offsets[joint] = places[joint] - places[parent]
    for joint, name in enumerate(JOINT_NAMES):
        ends[joint] = _end(name, joint, places)
    for segment, (part, end_at) in _MEASURED.items():
        if segment in segments_m:
            stretch = _stretch(segment, segments_m[segment] / stature_m, offsets, end_at)
            for side in ("Left", "Right"):
                offsets[JOINT_INDEX[side + end_at]] *= stretch
                ends[JOINT_INDEX[side + part]] *= stretch
    radii = np.array([_RADIUS[_part(name)] for name in JOINT_NAMES])
    starts, stops = _capsule_axes(ends, radii)
    scaled = [stature_m * array for array in (offsets, ends, starts, stops, radii)]
    for array in scaled:
        array.flags.writeable = False
    return Skeleton(stature_m, *scaled)


def _stretch(segment: str, fraction: float, offsets: FloatArray, end_at: str) -> float:
    usual = float(np.linalg.norm(offsets[JOINT_INDEX["Left" + end_at]]))
    if not _LEAST_STRETCH < fraction / usual < _MOST_STRETCH:
        raise SkeletonError(
            f"A {segment} of {fraction:.3f} times the stature does not fit a body, whose usual one "
            f"is {usual:.3f}: give its length in metres."
        )
    return fraction / usual


def _part(name: str) -> str:
    return name.removeprefix("Left").removeprefix("Right")


def _rest_position(name: str) -> tuple[float, float, float]:
    if name in _CENTRE:
        return _CENTRE[name]
    x, y, z = _RIGHT[_part(name)]
    return (-x if name.startswith("Left") else x, y, z)


def _end(name: str, joint: int, places: FloatArray) -> FloatArray:
    part = _part(name)
    if part in _SEGMENT_END_AT:
        next_joint = JOINT_INDEX[name.replace(part, _SEGMENT_END_AT[part])]
        return np.asarray(places[next_joint] - places[joint])
    if part == "Hand":
        return np.array((-_HAND_LENGTH if name.startswith("Left") else _HAND_LENGTH, 0.0, 0.0))
    return np.array((0.0, _HEAD_TOP, 0.0)) if part == "Head" else np.array(_TOE_TIP)


def _capsule_axes(ends: FloatArray, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return capsule axes whose rounded caps end where hand, head and toes end."""
    starts, stops = np.zeros_like(ends), ends.copy()
    for joint, name in enumerate(JOINT_NAMES):
        if _part(name) in {"Hand", "Head", "Toes"}:
            length = float(np.linalg.norm(ends[joint]))
            stops[joint] *= (length - radii[joint]) / length
    head = JOINT_INDEX["Head"]
    starts[head] = stops[head]
    return starts, stops
