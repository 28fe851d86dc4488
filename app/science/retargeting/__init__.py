"""Retarget the movement of any body to any avatar.

`propose_joint_map` identifies the joints of a rig, `retarget_motion` transfers a whole movement to
an avatar, optionally with feet locked to the ground, and `Retargeter` does so frame by frame.
`verify` and `check_table1` check the result.
"""

from app.science.retargeting.anatomy_checks import checked_skeleton
from app.science.retargeting.finger_names import finger_bones_of
from app.science.retargeting.fingers import captured_fingers, has_fingers
from app.science.retargeting.gait import Walk
from app.science.retargeting.generated_walk import example_walk
from app.science.retargeting.ground import Flat, Ground, Ramp, Steps
from app.science.retargeting.in_place import movement_in_place, movement_travelling
from app.science.retargeting.joint_chains import is_below
from app.science.retargeting.joint_map import (
    JointMap,
    JointMapError,
    Proposal,
    check_joint_map,
    propose_joint_map,
    unmapped_body_joints,
    unmapped_rig_joints,
)
from app.science.retargeting.leg_angles import LegAngles
from app.science.retargeting.pipeline import FloorClearance, Retargeted, Walks, retarget_motion
from app.science.retargeting.plan import IntArray
from app.science.retargeting.reference_avatars import (
    REFERENCE_JOINT_MAP,
    AvatarError,
    named_avatar,
    named_stature_m,
    reference_avatar,
)
from app.science.retargeting.t_pose import t_pose
from app.science.retargeting.table1 import TOLERANCE_DEG, Table1Row, check_table1
from app.science.retargeting.transfer import Retargeter
from app.science.retargeting.verification import AvatarFigures, Verification, verify

__all__ = [
    "REFERENCE_JOINT_MAP",
    "TOLERANCE_DEG",
    "AvatarError",
    "AvatarFigures",
    "Flat",
    "FloorClearance",
    "Ground",
    "IntArray",
    "JointMap",
    "JointMapError",
    "LegAngles",
    "Proposal",
    "Ramp",
    "Retargeted",
    "Retargeter",
    "Steps",
    "Table1Row",
    "Verification",
    "Walk",
    "Walks",
    "captured_fingers",
    "check_joint_map",
    "check_table1",
    "checked_skeleton",
    "example_walk",
    "finger_bones_of",
    "has_fingers",
    "is_below",
    "movement_in_place",
    "movement_travelling",
    "named_avatar",
    "named_stature_m",
    "propose_joint_map",
    "reference_avatar",
    "retarget_motion",
    "t_pose",
    "unmapped_body_joints",
    "unmapped_rig_joints",
    "verify",
]
