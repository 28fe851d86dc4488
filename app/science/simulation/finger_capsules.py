"""The shapes of a skeleton's fingers, for touches of a body that is not simulated by physics."""

from dataclasses import replace

import numpy as np

from app.science.avatar.body import finger_bones
from app.science.rotations import FloatArray, multiply, rotate
from app.science.skeleton import (
    FINGERS,
    JOINT_INDEX,
    SEGMENTS,
    BodySegments,
    Skeleton,
    WorldPose,
)

_SIDES = ("Left", "Right")
_HANDS = [JOINT_INDEX[f"{side}Hand"] for side in _SIDES]


def pointing(skeleton: Skeleton) -> Skeleton:
    """Return a skeleton whose hands end at the tips of their index fingers, which touch things."""
    ends_m = skeleton.ends_m.copy()
    for side, hand in zip(_SIDES, _HANDS, strict=True):
        length_m = abs(float(ends_m[hand, 0]))
        index = [one for one in finger_bones(side, length_m) if "Index" in one.part]
        reach_m = abs(index[0].joint_m[0]) + sum(abs(one.end_m[0]) for one in index)
        ends_m[hand, 0] = np.copysign(reach_m, ends_m[hand, 0])
    return replace(skeleton, ends_m=ends_m)


class FingerCapsules:
    """The capsules of the 30 finger parts of one body, in the order of `FINGER_PARTS`.

    The lengths are those of the avatar's fingers (`app.science.avatar.body.fingers`).
    """

    def __init__(self, skeleton: Skeleton) -> None:
        lengths_m = [abs(float(skeleton.ends_m[hand, 0])) for hand in _HANDS]
        bones = [
            bone
            for side, length_m in zip(_SIDES, lengths_m, strict=True)
            for bone in finger_bones(side, length_m)
        ]
        shape = (len(_SIDES), len(FINGERS), len(SEGMENTS), 3)
        self._joints_m: FloatArray = np.array([bone.joint_m for bone in bones]).reshape(shape)
        self._ends_m: FloatArray = np.array([bone.end_m for bone in bones]).reshape(shape)
        self._radii_m = skeleton.stature_m * np.array([bone.relative_radius for bone in bones])
        # The palm ends at the knuckle of the middle finger.
        self._palm_ends_m = self._joints_m[:, FINGERS.index("Middle"), 0]

    def added_to(
        self, body: BodySegments, world: WorldPose, fingers: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the axes (52, 2, 3) and radii (52,) of a body's capsules with its fingers.

        The hands' own capsules then end at the knuckles. `fingers` (30, 4) are local rotations.
        """
        local = fingers.reshape(len(_SIDES), len(FINGERS), len(SEGMENTS), 4)
        turn = np.repeat(world.rotations[_HANDS, np.newaxis], len(FINGERS), axis=1)
        place = np.repeat(world.positions_m[_HANDS, np.newaxis], len(FINGERS), axis=1)
        axes_m = np.empty((len(_SIDES), len(FINGERS), len(SEGMENTS), 2, 3))
        for segment in range(len(SEGMENTS)):
            place = place + rotate(turn, self._joints_m[:, :, segment])
            turn = multiply(turn, local[:, :, segment])
            axes_m[:, :, segment, 0] = place
            axes_m[:, :, segment, 1] = place + rotate(turn, self._ends_m[:, :, segment])
        own = body.axes_m.copy()
        palm_m = rotate(world.rotations[_HANDS], self._palm_ends_m)
        own[_HANDS, 1] = world.positions_m[_HANDS] + palm_m
        return (
            np.concatenate((own, axes_m.reshape(-1, 2, 3))),
            np.concatenate((body.radii_m, self._radii_m)),
        )
