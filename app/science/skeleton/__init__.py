"""Model the 22-joint body of Reembody: joints, proportions, forward kinematics and movement."""

from app.science.skeleton.clearance import clearance_m
from app.science.skeleton.fingers import (
    FINGER_COUNT,
    FINGER_PARTS,
    FINGERS,
    PARTS_PER_HAND,
    SEGMENTS,
    finger_of,
)
from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES, PARENTS
from app.science.skeleton.kinematics import (
    BodySegments,
    Pose,
    WorldPose,
    body_part_segments,
    forward_kinematics,
)
from app.science.skeleton.model import Skeleton, SkeletonError, build_skeleton
from app.science.skeleton.movement import (
    Movement,
    continuous,
    largest_step_rad,
    loop,
    mean_rotations,
    resample,
)
from app.science.skeleton.soles import (
    HALF_FOOT_BREADTH,
    TOES_JOINT_HEIGHT,
    flat_soles,
    ground_height,
    sole_height,
)

__all__ = [
    "FINGERS",
    "FINGER_COUNT",
    "FINGER_PARTS",
    "HALF_FOOT_BREADTH",
    "JOINT_COUNT",
    "JOINT_INDEX",
    "JOINT_NAMES",
    "PARENTS",
    "PARTS_PER_HAND",
    "SEGMENTS",
    "TOES_JOINT_HEIGHT",
    "BodySegments",
    "Movement",
    "Pose",
    "Skeleton",
    "SkeletonError",
    "WorldPose",
    "body_part_segments",
    "build_skeleton",
    "clearance_m",
    "continuous",
    "finger_of",
    "flat_soles",
    "forward_kinematics",
    "ground_height",
    "largest_step_rad",
    "loop",
    "mean_rotations",
    "resample",
    "sole_height",
]
