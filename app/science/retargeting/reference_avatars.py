"""Avatars of any stature, made from published body proportions.

A reference avatar is the product's own body (`app.science.skeleton`) as a `Rig`: 22 joints named
after HumanBodyBones, T-pose at rest, facing -z, left is -x. Avatars of different stature differ by
one scale factor only. `thigh_share` moves the knee along the leg: the same leg length with another
thigh:shin ratio, for which scaling cannot keep the feet from sliding.

The paper's avatars are 130, 165 and 190 cm tall (Degen et al. 2022, figure 7); their leg lengths
are not published, so these avatars are consistent with the paper's, but not identical.
"""

import re

import numpy as np

from app.science.retargeting.joint_map import JointMap
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, identity
from app.science.skeleton import (
    JOINT_COUNT,
    JOINT_INDEX,
    JOINT_NAMES,
    PARENTS,
    Movement,
    SkeletonError,
    build_skeleton,
)

PAPER_STATURES_M: tuple[float, ...] = (1.30, 1.65, 1.90)
"""Statures of the paper's three avatars."""

REFERENCE_JOINT_MAP: JointMap = {name: name for name in JOINT_NAMES}
"""A reference avatar's joints are named like the body's, so each is mapped to itself."""

_KEY = re.compile(r"(\d{1,3}(?:\.\d{1,3})?)\s*cm", re.IGNORECASE)
_FREE_ENDS = ("Head", "LeftHand", "RightHand", "LeftToes", "RightToes")
_SHARES = (0.3, 0.7)


class AvatarError(ValueError):
    """There is no avatar of this name, stature or proportion."""


def reference_avatar(stature_m: float, *, thigh_share: float | None = None) -> Rig:
    """Build the reference avatar of a stature.

    Args:
        stature_m: body height, 0.5 to 2.6 m.
        thigh_share: length of the thigh over thigh plus shin, 0.3 to 0.7; None for the published
            proportion, 0.499.

    Raises:
        AvatarError: stature or share out of range.
    """
    try:
        skeleton = build_skeleton(stature_m)
    except SkeletonError as error:
        raise AvatarError(str(error)) from None
    offsets = skeleton.offsets_m.copy()
    if thigh_share is not None:
        _move_knees(offsets, thigh_share)
    ends = skeleton.ends_m.tolist()
    return Rig(
        names=JOINT_NAMES,
        parents=PARENTS,
        offsets_m=offsets,
        rest_rotations=identity(JOINT_COUNT),
        ends=tuple(
            (
                JOINT_INDEX[n],
                (ends[JOINT_INDEX[n]][0], ends[JOINT_INDEX[n]][1], ends[JOINT_INDEX[n]][2]),
            )
            for n in _FREE_ENDS
        ),
    )


def named_stature_m(key: str) -> float | None:
    """Return the stature in metres of a key such as `165cm`; None if it is not such a key."""
    match = _KEY.fullmatch(key.strip())
    return float(match[1]) / 100.0 if match else None


def named_avatar(key: str) -> Rig:
    """Return the reference avatar of a key such as `165cm`.

    Raises:
        AvatarError: the key is not valid; the message says which keys are.
    """
    stature_m = named_stature_m(key)
    if stature_m is None:
        raise AvatarError(
            f"There is no avatar {key!r}: valid are 130cm, 165cm, 190cm and any other stature from"
            " 50cm to 260cm."
        )
    return reference_avatar(stature_m)


def as_movement(motion: RigMotion) -> Movement:
    """Return a reference avatar's movement as one of the product's body: (N, 3) and (N, 22, 4).

    Raises:
        AvatarError: the rig is not a reference avatar.
    """
    if motion.rig.names != JOINT_NAMES or motion.rig.parents != PARENTS:
        raise AvatarError(
            "Only a reference avatar's movement has the 22 body joints: retarget to one first."
        )
    return Movement(motion.rate_hz, motion.root_positions_m, motion.rotations)


def _move_knees(offsets_m: FloatArray, thigh_share: float) -> None:
    low, high = _SHARES
    if not low <= thigh_share <= high:
        raise AvatarError(f"A thigh share of {thigh_share} is outside {low} to {high}.")
    for side in ("Left", "Right"):
        knee, ankle = JOINT_INDEX[f"{side}LowerLeg"], JOINT_INDEX[f"{side}Foot"]
        leg = float(np.linalg.norm(offsets_m[knee]) + np.linalg.norm(offsets_m[ankle]))
        offsets_m[knee] = (0.0, -leg * thigh_share, 0.0)
        offsets_m[ankle] = (0.0, -leg * (1.0 - thigh_share), 0.0)
