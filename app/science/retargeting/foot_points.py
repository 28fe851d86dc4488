"""The points of a body that may touch the ground: feet, toes and everything attached to them."""

from typing import cast

import numpy as np

from app.science.retargeting.joint_chains import is_below
from app.science.retargeting.joint_map import JointMap
from app.science.rig import Rig, RigMotion
from app.science.rotations import (
    FloatArray,
    Quaternion,
    Vector,
    q_multiply,
    q_rotate,
    rotate,
    v_add,
)

_FOOT_PARTS = ("LeftFoot", "LeftToes", "RightFoot", "RightToes")


class FootPoints:
    """Joints and free ends of a rig's feet; of its whole body if no foot is mapped.

    Attributes:
        joints: (P,) the joint with which each point moves.
    """

    def __init__(self, rig: Rig, joint_map: JointMap) -> None:
        """Find the points; raise RigError if the map names a joint that the rig lacks."""
        feet = [rig.index(joint_map[part]) for part in _FOOT_PARTS if part in joint_map] or [0]
        low = [
            joint
            for joint in range(rig.joint_count)
            if any(is_below(rig, joint, foot) for foot in feet)
        ]
        ends = [(joint, end) for joint, end in rig.ends if joint in low]
        self._points: list[tuple[int, Vector]] = [(joint, (0.0, 0.0, 0.0)) for joint in low]
        self._points += ends
        self.joints = tuple(joint for joint, _ in self._points)
        needed = [
            any(is_below(rig, foot, joint) for foot in low) for joint in range(len(rig.names))
        ]
        self._order = [joint for joint, is_needed in enumerate(needed) if is_needed and joint > 0]
        self._parents = rig.parents
        self._offsets = cast("list[Vector]", rig.offsets_m.tolist())

    def places_m(self, root_position_m: FloatArray, rotations: FloatArray) -> FloatArray:
        """Return the positions of the points, (P, 3), for one frame, (3,) and (J, 4)."""
        local = cast("list[Quaternion]", rotations.tolist())
        # Plain floats: the few dozen products of a single frame are slower with arrays.
        turns: dict[int, Quaternion] = {0: local[0]}
        places: dict[int, Vector] = {0: cast("Vector", tuple(root_position_m.tolist()))}
        for joint in self._order:
            parent = self._parents[joint]
            offset = q_rotate(turns[parent], self._offsets[joint])
            places[joint] = v_add(places[parent], offset)
            turns[joint] = q_multiply(turns[parent], local[joint])
        points = [v_add(places[j], q_rotate(turns[j], at)) for j, at in self._points]
        return np.array(points)

    def all_places_m(self, motion: RigMotion) -> FloatArray:
        """Return the positions of the points in all frames, (N, P, 3)."""
        positions, world = motion.world()
        places = [positions[:, j] + rotate(world[:, j], np.array(at)) for j, at in self._points]
        return np.stack(places, axis=1)
