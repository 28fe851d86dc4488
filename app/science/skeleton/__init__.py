"""The body: joints, proportions, forward kinematics, and movement brought onto them."""

from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES, PARENTS
from app.science.skeleton.kinematics import (
    BodySegments,
    Pose,
    WorldPose,
    body_part_segments,
    forward_kinematics,
)
from app.science.skeleton.model import Skeleton, SkeletonError, build_skeleton

__all__ = [
    "JOINT_COUNT",
    "JOINT_INDEX",
    "JOINT_NAMES",
    "PARENTS",
    "BodySegments",
    "Pose",
    "Skeleton",
    "SkeletonError",
    "WorldPose",
    "body_part_segments",
    "build_skeleton",
    "forward_kinematics",
]
