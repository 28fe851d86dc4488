"""Bring any rest pose into the ideal T-pose, which makes a source and an avatar comparable.

Rotations of a movement are transferred relative to a pose that both bodies share. A rest pose may
be any pose that its author chose (arms half down, legs apart); the T-pose is made from it, root to
leaf, by turning each joint by the smallest rotation that brings its bone onto its axis. With k the
bone's direction in the world at that moment, and v the axis,

    k = (P_child - P_parent) / |P_child - P_parent|,   q_diff = the shortest turn from v to k,
    world_from_joint <- q_diff^-1 world_from_joint,

after which everything below the joint has turned with it. A bone that points in exactly the
opposite direction is turned about the axis along which the body faces.

- **Torso** (Hips to Neck) along +up, **legs** (UpperLeg, LowerLeg) along -up, **arms** (UpperArm,
  LowerArm) along +left and -left. A bone runs from a mapped joint to the next mapped joint of its
  limb; joints between them keep their local rotation, as do **collar bones** and **toes**. A bone
  without length (under 0.1 mm) has no direction, and its joint keeps its local rotation.
- **Feet** stand on the floor at rest, so a foot is turned back to its rest rotation in the world.
- **Head and hands** have no next joint. Where the rig's own axes lie along its bones, as Unreal's
  do, `local_axes` names the axis that is aligned: +x for the head and left hand, -x for the right
  hand (`UNREAL_LOCAL_AXES`). Otherwise a hand is aligned by its longest finger: the farthest point
  below it at rest, if that lies within 60 degrees of the forearm's direction; a hand without one
  continues its forearm (keeps its local rotation). A head without an axis looks straight ahead at
  rest, regardless of its neck, and is turned back to that like a foot.

A rig may face in any direction at rest. The direction is determined from its left-right axis, and
the rig is aligned in its own facing: `facing` turns the axes to the rig's.

Source: Degen et al. (2022), "Methodical approach to integrate human movement diversity ...", J.
Transportation Technologies 12:296-309, section 3. Its errors are resolved as
`tests/science/retargeting/test_pitfalls.py` shows.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from app.science.retargeting.axes import CANONICAL, Axes, swing, unit
from app.science.retargeting.bones import Bone, bones_of, joints_of, rest_facing
from app.science.retargeting.joint_map import JointMap
from app.science.rig import Rig, to_local
from app.science.rotations import FloatArray, Vector, conjugate, multiply, rotate

UNREAL_LOCAL_AXES: Mapping[str, Vector] = MappingProxyType(
    {"Head": (1.0, 0.0, 0.0), "LeftHand": (1.0, 0.0, 0.0), "RightHand": (-1.0, 0.0, 0.0)}
)
_AS_AT_REST = frozenset({"LeftFoot", "RightFoot"})


@dataclass(frozen=True, eq=False)
class TPose:
    """A rig in its T-pose.

    Attributes:
        rig: the rig, in its own rest pose.
        axes: the frame it was aligned in.
        facing: (4,) world_from_axes, a rotation about up: how the rig faces at rest.
        local_rotations: (J, 4) rotations parent_from_joint.
        world_rotations: (J, 4) rotations world_from_joint.
        positions_m: (J, 3) positions in the world, the root at its rest position.
        bones: the bones that were aligned, root to leaf.
    """

    rig: Rig
    axes: Axes
    facing: FloatArray
    local_rotations: FloatArray
    world_rotations: FloatArray
    positions_m: FloatArray
    bones: tuple[Bone, ...]

    def misalignment(self) -> FloatArray:
        """Return |k - v| of each aligned bone, (B,): its remaining deviation from its axis."""
        dtype = self.local_rotations.dtype
        joints = [bone.joint for bone in self.bones]
        along = np.array([unit(bone.direction.astype(dtype)) for bone in self.bones], dtype=dtype)
        along = along.reshape(-1, 3)
        axes = np.array([bone.axis for bone in self.bones], dtype=dtype).reshape(-1, 3)
        gaps = rotate(self.world_rotations[joints], along) - rotate(self.facing, axes)
        return np.asarray(np.linalg.norm(gaps, axis=-1), dtype=dtype)


def t_pose(
    rig: Rig,
    joint_map: JointMap,
    axes: Axes = CANONICAL,
    *,
    local_axes: Mapping[str, Vector] = MappingProxyType({}),
    dtype: npt.DTypeLike = np.float64,
) -> TPose:
    """Bring a rig into the T-pose; see the module for the rules.

    Args:
        rig: any skeleton; its rest pose is the start.
        joint_map: body joint (`app.science.skeleton.JOINT_NAMES`) -> joint of the rig. Body joints
            that are not mapped are not aligned.
        axes: the frame, by default y up with the left arm along -x.
        local_axes: body joint -> the rig joint's own axis along its bone, for head and hands.
        dtype: precision of the computation, float64 or float32.

    Raises:
        JointMapError: the map does not match the rig, or leaves the hips out.
    """
    joints = joints_of(rig, joint_map)
    bones = bones_of(rig, joints, axes, local_axes)
    facing = rest_facing(rig, joints, axes)
    rest = rig.rest_world()[1].astype(dtype)
    at_rest = {joints[name] for name in joints if name in _AS_AT_REST}
    if "Head" in joints and "Head" not in {bone.body_joint for bone in bones}:
        at_rest.add(joints["Head"])
    local, world = _aligned(rig, rest, axes, facing.astype(dtype), bones, at_rest)
    positions = rig.offsets_m.astype(dtype)
    for joint, parent in enumerate(rig.parents[1:], start=1):
        positions[joint] = positions[parent] + rotate(world[parent], positions[joint])
    return TPose(rig, axes, facing.astype(dtype), local, world, positions, bones)


def _aligned(
    rig: Rig,
    rest: FloatArray,
    axes: Axes,
    facing: FloatArray,
    bones: tuple[Bone, ...],
    at_rest: set[int],
) -> tuple[FloatArray, FloatArray]:
    """Return the local and world rotations of the aligned rig.

    One pass is sufficient, as a parent's rotation is applied before its children are aligned.
    """
    bone_of = {bone.joint: bone for bone in bones}
    forward = rotate(facing, np.array(axes.forward, dtype=rest.dtype))
    kept = rig.rest_rotations.astype(rest.dtype)
    world = rest.copy()
    for joint, parent in enumerate(rig.parents):
        if parent >= 0:
            world[joint] = unit(multiply(world[parent], kept[joint]))
        if joint in at_rest:
            world[joint] = rest[joint]
        elif joint in bone_of:
            bone = bone_of[joint]
            v = rotate(facing, bone.axis.astype(rest.dtype))
            k = rotate(world[joint], bone.direction.astype(rest.dtype))
            q_diff = swing(v, k, forward)
            world[joint] = unit(multiply(_inverse(q_diff), world[joint]))
    return to_local(rig, world).astype(rest.dtype), world


def _inverse(q: FloatArray) -> FloatArray:
    return conjugate(q).astype(q.dtype)
