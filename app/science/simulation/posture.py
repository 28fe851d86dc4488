"""Compute joint rotations from hips, feet and finger tip: two-bone limbs on a trunk.

All functions take a list of 22 local rotations and modify those of their limb. They process single
frames at 90 Hz in plain floats: the same in arrays takes five times as long.
"""

from math import exp, sqrt

from app.science.rotations import (
    IDENTITY,
    Quaternion,
    Vector,
    q_blend,
    q_inverse_multiply,
    q_multiply,
    q_rotate,
    v_add,
    v_length,
    v_scale,
    v_subtract,
)
from app.science.simulation.two_bone import (
    arm_rotation,
    hand_rotation,
    leg_rotation,
    solve_two_bone,
)
from app.science.skeleton import JOINT_INDEX, Skeleton

SIDE_NAMES = ("Left", "Right")
SIDE_SIGNS = (-1.0, 1.0)
_KNEE_POLE: Vector = (0.0, 0.0, -1.0)
_TRUNK = tuple(JOINT_INDEX[name] for name in ("Spine", "Chest", "UpperChest"))
_STRAIGHTEST = 0.995
_SOFT_FROM = 0.95


class Posture:
    """Places the limbs of one skeleton, whose segment lengths it stores as plain numbers."""

    def __init__(self, skeleton: Skeleton) -> None:
        self._offsets: list[Vector] = [(x, y, z) for x, y, z in skeleton.offsets_m.tolist()]
        self.ankle_height_m = skeleton.ankle_height_m
        self.standing_m = skeleton.standing_hips_m
        self._thigh_m = skeleton.length_m("LeftLowerLeg")
        self._shank_m = skeleton.length_m("LeftFoot")
        self._upper_arm_m = skeleton.length_m("LeftLowerArm")
        self._forearm_m = skeleton.length_m("LeftHand")
        self.hand_m = float(skeleton.ends_m[JOINT_INDEX["RightHand"], 0])
        self.arm_m = self._upper_arm_m + self._forearm_m
        self.shoulder_m: Vector = (
            0.129 * skeleton.stature_m, 0.818 * skeleton.stature_m, 0.0
        )  # fmt: skip
        self._trunk_m = self.shoulder_m[1] - self.standing_m

    def lean(self, local: list[Quaternion], shift_m: tuple[float, float]) -> None:
        """Bend the three spine joints so that the shoulders move by about (x, z) metres."""
        # Each joint bends by a third; half angles, so a sixth. Leaning to -z turns about -x.
        x, z = shift_m[1] / self._trunk_m / 6.0, -shift_m[0] / self._trunk_m / 6.0
        scale = 1.0 / sqrt(1.0 + x * x + z * z)
        bend = (scale, scale * x, 0.0, scale * z)
        for joint in _TRUNK:
            local[joint] = q_multiply(bend, local[joint])

    def highest_hips(
        self, hips_m: tuple[float, float], hips: Quaternion, ankles: tuple[Vector, Vector]
    ) -> float:
        """Return the greatest height of the hips at (x, z) from which both legs reach."""
        leg_m = _STRAIGHTEST * (self._thigh_m + self._shank_m)
        height = float("inf")
        for name, (ax, ay, az) in zip(SIDE_NAMES, ankles, strict=True):
            sx, sy, sz = q_rotate(hips, self._offsets[JOINT_INDEX[f"{name}UpperLeg"]])
            dx, dz = ax - hips_m[0] - sx, az - hips_m[1] - sz
            height = min(height, ay - sy + sqrt(max(leg_m * leg_m - dx * dx - dz * dz, 0.0)))
        return height

    def legs(self, local: list[Quaternion], root_m: Vector, ankles: tuple[Vector, Vector]) -> None:
        """Place both ankles, with knees forward and feet flat and straight ahead."""
        for name, ankle in zip(SIDE_NAMES, ankles, strict=True):
            first = JOINT_INDEX[f"{name}UpperLeg"]
            socket = v_add(root_m, q_rotate(local[0], self._offsets[first]))
            limb = solve_two_bone(socket, ankle, self._thigh_m, self._shank_m, _KNEE_POLE)
            upper = leg_rotation(limb.upper, limb.normal)
            lower = leg_rotation(limb.lower, limb.normal)
            local[first] = q_inverse_multiply(local[0], upper)
            local[first + 1] = q_inverse_multiply(upper, lower)
            local[first + 2] = q_inverse_multiply(lower, IDENTITY)
            local[first + 3] = IDENTITY

    def arm(
        self,
        local: list[Quaternion],
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
        sign, first = SIDE_SIGNS[side], JOINT_INDEX[f"{SIDE_NAMES[side]}UpperArm"]
        shoulder, turn = self._shoulder(local, root_m, first)
        wrist = v_subtract(tip_m, v_scale(fingers, self.hand_m))
        pole = (0.35 * sign, -1.0, 0.25)
        way = v_subtract(wrist, shoulder)
        away = max(v_length(way), 1e-9)
        softly = self._soft_reach(away)
        limb = solve_two_bone(
            shoulder,
            v_add(shoulder, v_scale(way, softly / away)),
            self._upper_arm_m,
            self._forearm_m,
            pole,
        )
        upper = arm_rotation(limb.upper, limb.normal, sign)
        lower = arm_rotation(limb.lower, limb.normal, sign)
        hand = hand_rotation(fingers, limb.normal, sign)
        solved = (
            q_inverse_multiply(turn, upper),
            q_inverse_multiply(upper, lower),
            q_inverse_multiply(lower, hand),
        )
        for joint, rotation in enumerate(solved, first):
            local[joint] = rotation if work >= 1.0 else q_blend(local[joint], rotation, work)
        return v_scale(way, (away - softly) / away)

    def _shoulder(
        self, local: list[Quaternion], root_m: Vector, upper_arm: int
    ) -> tuple[Vector, Quaternion]:
        """Return the position of the shoulder joint and world_from_collar_bone."""
        place, turn = root_m, local[0]
        for joint in (*_TRUNK, upper_arm - 1):
            place = v_add(place, q_rotate(turn, self._offsets[joint]))
            turn = q_multiply(turn, local[joint])
        return v_add(place, q_rotate(turn, self._offsets[upper_arm])), turn

    def _soft_reach(self, away_m: float) -> float:
        """Return how far the arm stretches towards a point at this distance.

        Up to 95 % of its length it stretches exactly as far; beyond, it approaches full length
        asymptotically, since an elbow that has to become straight abruptly would have to turn
        infinitely fast.
        """
        soft_m, most_m = _SOFT_FROM * self.arm_m, self.arm_m
        if away_m <= soft_m:
            return away_m
        room_m = most_m - soft_m
        return most_m - room_m * exp((soft_m - away_m) / room_m)
