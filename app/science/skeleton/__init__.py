"""The product's own body: joints, proportions, forward kinematics and movement."""

from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES, PARENTS
from app.science.skeleton.kinematics import (
    BodySegments,
    Pose,
    WorldPose,
    body_part_segments,
    forward_kinematics,
)
from app.science.skeleton.model import Skeleton, SkeletonError, build_skeleton
from app.science.skeleton.movement import Movement, largest_step_rad, loop, resample

__all__ = [
    "JOINT_COUNT",
    "JOINT_INDEX",
    "JOINT_NAMES",
    "PARENTS",
    "BodySegments",
    "Movement",
    "Pose",
    "Skeleton",
    "SkeletonError",
    "WorldPose",
    "body_part_segments",
    "build_skeleton",
    "forward_kinematics",
    "largest_step_rad",
    "loop",
    "resample",
]
