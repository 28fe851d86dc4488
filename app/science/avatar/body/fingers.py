"""Lengths of the fingers of one hand and their positions on the palm, in the T-pose.

Published (Buchholz, Armstrong and Goldstein 1992, Ergonomics 35(3), 261-273): lengths of the finger
segments between joint centres, and distances of the knuckles and of the root of the thumb from the
wrist, as fractions of the length of the hand; their distances from the axis of the middle finger,
as fractions of the breadth of the hand.

Estimated by us: the breadth of the hand is 0.44 of its length; in the T-pose the fingers lie flat
and parallel, the thumb points 45 degrees forward in the plane of the palm, and its root lies at the
level of the palm; the thickness of the fingers.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import sqrt

from app.science.avatar.body.parts import FINGERS, SEGMENTS
from app.science.rotations import Vector, v_scale

HAND_BREADTH = 0.44
"""Breadth of the palm at the knuckles, as a fraction of the length of the hand."""
_SEGMENT_LENGTHS: Mapping[str, tuple[float, float, float]] = {  # of the length of the hand
    "Thumb": (0.251, 0.196, 0.158),
    "Index": (0.245, 0.143, 0.097),
    "Middle": (0.266, 0.170, 0.108),
    "Ring": (0.244, 0.165, 0.107),
    "Little": (0.204, 0.117, 0.093),
}
# Distance from the wrist (of the hand's length) and towards the thumb (of its breadth).
_ROOTS: Mapping[str, tuple[float, float]] = {
    "Thumb": (0.073, 0.196),
    "Index": (0.447, 0.251),
    "Middle": (0.446, 0.0),
    "Ring": (0.409, -0.206),
    "Little": (0.368, -0.402),
}
_RADII: Mapping[str, float] = {  # of the stature
    "Thumb": 0.0056,
    "Index": 0.0048,
    "Middle": 0.0048,
    "Ring": 0.0046,
    "Little": 0.0041,
}
_THINNER = (1.0, 0.92, 0.84)  # towards the tip
_SQRT_HALF = sqrt(0.5)


@dataclass(frozen=True)
class FingerBone:
    """One segment of a finger.

    Attributes:
        part: HumanBodyBones name.
        joint_m: its joint in the frame of its parent.
        end_m: the next joint, or the tip, in its own frame.
        relative_radius: half its thickness as a fraction of the stature.
    """

    part: str
    joint_m: Vector
    end_m: Vector
    relative_radius: float


def finger_bones(side: str, hand_m: float) -> Iterator[FingerBone]:
    """Yield the fifteen bones of a hand of this length, finger by finger, each from root to tip."""
    outwards = -1.0 if side == "Left" else 1.0
    for finger in FINGERS:
        along, towards_thumb = _ROOTS[finger]
        straight = (outwards, 0.0, 0.0)
        aslant = (outwards * _SQRT_HALF, 0.0, -_SQRT_HALF)
        direction = aslant if finger == "Thumb" else straight
        joint: Vector = (outwards * along * hand_m, 0.0, -towards_thumb * HAND_BREADTH * hand_m)
        rows = zip(SEGMENTS, _SEGMENT_LENGTHS[finger], _THINNER, strict=True)
        for segment, length, thinner in rows:
            end = v_scale(direction, length * hand_m)
            yield FingerBone(f"{side}{finger}{segment}", joint, end, _RADII[finger] * thinner)
            joint = end
