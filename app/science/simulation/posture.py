"""Compute joint rotations from hips, feet and finger tip: two-bone limbs on a trunk.

All functions take a pose, an array (22, 4) of local rotations, and modify those of their limb.
"""

import numpy as np

from app.science.rotations import FloatArray, Vector
from app.science.skeleton import JOINT_INDEX, Skeleton

SIDE_NAMES = ("Left", "Right")
SIDE_SIGNS = (-1.0, 1.0)
_TRUNK = tuple(JOINT_INDEX[name] for name in ("Spine", "Chest", "UpperChest"))
_STRAIGHTEST = 0.995


class Posture:
    """Places the limbs of one skeleton, whose segment lengths it stores as plain numbers."""

    def __init__(self, skeleton: Skeleton) -> None:
        from app.science.simulation import posture_kernels  # loads the compiler

        self._kernels = posture_kernels
        self._offsets_m = np.ascontiguousarray(skeleton.offsets_m, dtype=np.float64)
        self._trunk = np.array(_TRUNK)
        self._thighs = np.array([JOINT_INDEX[f"{side}UpperLeg"] for side in SIDE_NAMES])
        upper_arms = (JOINT_INDEX[f"{side}UpperArm"] for side in SIDE_NAMES)
        self._arms = [np.array((*_TRUNK, arm - 1, arm)) for arm in upper_arms]
        self.ankle_height_m = skeleton.ankle_height_m
        self.standing_m = skeleton.standing_hips_m
        self._thigh_m = skeleton.length_m("LeftLowerLeg")
        self._shank_m = skeleton.length_m("LeftFoot")
        upper_arm_m, forearm_m = skeleton.length_m("LeftLowerArm"), skeleton.length_m("LeftHand")
        self.hand_m = float(skeleton.ends_m[JOINT_INDEX["RightHand"], 0])
        self.arm_m = upper_arm_m + forearm_m
        self._arm_lengths_m: Vector = (upper_arm_m, forearm_m, self.hand_m)
        self.shoulder_m: Vector = (
            0.129 * skeleton.stature_m, 0.818 * skeleton.stature_m, 0.0
        )  # fmt: skip
        self._trunk_m = self.shoulder_m[1] - self.standing_m

    def lean(self, local: FloatArray, shift_m: tuple[float, float]) -> None:
        """Bend the three spine joints so that the shoulders move by about (x, z) metres."""
        # Each joint bends by a third; half angles, so a sixth. Leaning to -z turns about -x.
        x, z = shift_m[1] / self._trunk_m / 6.0, -shift_m[0] / self._trunk_m / 6.0
        self._kernels.bend_trunk(local, self._trunk, x, z)

    def highest_hips(
        self, hips_m: tuple[float, float], local: FloatArray, ankles: tuple[Vector, Vector]
    ) -> float:
        """Return the greatest height of the hips at (x, z) from which both legs reach."""
        leg_m = _STRAIGHTEST * (self._thigh_m + self._shank_m)
        return self._kernels.highest_hips(
            local, self._offsets_m, self._thighs, hips_m, ankles, leg_m
        )

    def legs(self, local: FloatArray, root_m: Vector, ankles: tuple[Vector, Vector]) -> None:
        """Place both ankles, with knees forward and feet flat and straight ahead."""
        self._kernels.place_legs(
            local, self._offsets_m, self._thighs, root_m, ankles, self._thigh_m, self._shank_m
        )

    def arm(
        self,
        local: FloatArray,
        root_m: Vector,
        side: int,
        tip_m: Vector,
        fingers: Vector,
        work: float,
    ) -> Vector:
        """Move a finger tip to `tip_m`, by the share `work`; `fingers` is their unit direction.

        Returns the vector from the reached position of the wrist to its goal: zero if it is
        reached.
        """
        return self._kernels.place_arm(
            local,
            self._offsets_m,
            self._arms[side],
            SIDE_SIGNS[side],
            root_m,
            tip_m,
            fingers,
            self._arm_lengths_m,
            work,
        )

    def blended(self, start: FloatArray, end: FloatArray, share: float) -> FloatArray:
        """Return the pose a share of the way from one pose to another."""
        return self._kernels.blended(start, end, share)
