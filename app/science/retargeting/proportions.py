"""The ratio of two bodies' sizes, by which the hips' travel is scaled.

The length of a step is proportional to the length of the legs, so scale = leg length avatar /
source, each thigh plus shin, the mean of both sides. If the source has no legs (upper body only),
the ratio of the trunks, hips to neck, is used if both bodies have one, else 1.

Source: Degen et al. (2022), section 2.3.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.t_pose import TPose

ScaledBy = Literal["legs", "trunk", "nothing"]
_TRUNK_ENDS = ("Neck", "Head", "UpperChest", "Chest")
_SHORTEST_M = 1e-3


@dataclass(frozen=True)
class Scale:
    """A factor on lengths, and the body part that determined it."""

    factor: float
    scaled_by: ScaledBy


def leg_length_m(pose: TPose, joint_map: JointMap) -> float | None:
    """Return thigh plus shin, the mean of the mapped sides; None for a body without legs."""
    sides = []
    for side in ("Left", "Right"):
        names = [f"{side}{part}" for part in ("UpperLeg", "LowerLeg", "Foot")]
        if all(name in joint_map for name in names):
            upper, lower, foot = (pose.positions_m[pose.rig.index(joint_map[n])] for n in names)
            sides.append(float(np.linalg.norm(lower - upper) + np.linalg.norm(foot - lower)))
    length = float(np.mean(sides)) if sides else 0.0
    return length if length > _SHORTEST_M else None


def scale_between(
    source: TPose, source_map: JointMap, avatar: TPose, avatar_map: JointMap
) -> Scale:
    """Return the ratio of the avatar's size to the source's."""
    source_m, avatar_m = leg_length_m(source, source_map), leg_length_m(avatar, avatar_map)
    if source_m is not None and avatar_m is not None:
        return Scale(avatar_m / source_m, "legs")
    for end in _TRUNK_ENDS:
        if end in source_map and end in avatar_map:
            source_m, avatar_m = (
                _trunk_m(source, source_map, end),
                _trunk_m(avatar, avatar_map, end),
            )
            if min(source_m, avatar_m) > _SHORTEST_M:
                return Scale(avatar_m / source_m, "trunk")
    return Scale(1.0, "nothing")


def _trunk_m(pose: TPose, joint_map: JointMap, end: str) -> float:
    hips, top = (pose.positions_m[pose.rig.index(joint_map[name])] for name in ("Hips", end))
    return float(np.linalg.norm(top - hips))
