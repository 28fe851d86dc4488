"""Compute the centre of mass of a captured skeleton, with the masses of de Leva (1996).

Each segment's centre lies between two joints. Trunk landmarks are placed on the line from the
middle of the hip joints to the neck: navel at .26, lower end of the breastbone at .61. The masses
of head and hands are placed at their joints, that of a foot without toes at the ankle. For a person
who walks upright the position on the floor is then accurate to a few millimetres.
"""

from collections.abc import Mapping

import numpy as np

from app.science.avatar.body import mass_fractions, segments_of
from app.science.rig import RigMotion
from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError

_NAVEL, _BREASTBONE, _VERTEBRA = 0.26, 0.61, 1.0
_TRUNK = {
    "Lower trunk": (_NAVEL, 0.0),
    "Middle trunk": (_BREASTBONE, _NAVEL),
    "Upper trunk 2": (_VERTEBRA, _BREASTBONE),
}
_LIMBS = {
    "Upper arm": ("UpperArm", "LowerArm"),
    "Forearm": ("LowerArm", "Hand"),
    "Hand 2": ("Hand", "Hand"),
    "Thigh": ("UpperLeg", "LowerLeg"),
    "Shank": ("LowerLeg", "Foot"),
    "Foot": ("Foot", "Toes"),
}
_SIDES = ("Left", "Right")
_PAIRED = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
NEEDED = ("Neck", *(side + joint for side in _SIDES for joint in _PAIRED))
"""Body joints that are needed for the centre of mass."""


def centre_of_mass(motion: RigMotion, joint_map: Mapping[str, str]) -> FloatArray:
    """Return the centre of mass (N, 3) in the world, metres.

    Args:
        motion: the movement of a whole body.
        joint_map: body joint -> rig joint, as `propose_joint_map` derives it from names.

    Raises:
        WalkingError: a joint of `NEEDED` is not mapped; the hips can be tracked instead.
    """
    missing = [joint for joint in NEEDED if joint not in joint_map]
    if missing:
        raise WalkingError(
            f"The centre of mass needs {', '.join(missing)}, which the skeleton does not have or"
            " the joint map does not name: map them, or track the hips instead."
        )
    positions, _ = motion.world()
    at = {joint: positions[:, motion.rig.index(name)] for joint, name in joint_map.items()}
    at = {"Head": at["Neck"], "LeftToes": at["LeftFoot"], "RightToes": at["RightFoot"]} | at
    shares, rows = mass_fractions("average"), segments_of("average")
    hips = (at["LeftUpperLeg"] + at["RightUpperLeg"]) / 2.0
    centre = shares["Head"] * at["Head"]
    for name, (upper, lower) in _TRUNK.items():
        height = upper + rows[name].center * (lower - upper)
        centre = centre + shares[name] * (hips + height * (at["Neck"] - hips))
    for name, (inner, outer) in _LIMBS.items():
        for side in _SIDES:
            near, far = at[side + inner], at[side + outer]
            centre = centre + shares[name] * (near + rows[name].center * (far - near))
    return np.asarray(centre, dtype=np.float64)
