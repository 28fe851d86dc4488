"""Measure how far an avatar's joints are from the rotations that they should have.

`joint_errors` computes the error as defined, `joint_error_summary` its statistics over a phase,
`recorded_errors` the errors of two recorded streams, against the present pose and against the
delayed command, and `joint_error_course` their course over the phase's active time.
"""

from app.science.joint_error.course import COURSE_BIN_S, active_times, joint_error_course
from app.science.joint_error.errors import (
    ERROR_AXES,
    ERROR_JOINTS,
    ERROR_JOINTS_WITH_FINGERS,
    Clipping,
    JointErrorSummary,
    joint_error_summary,
    joint_errors,
)
from app.science.joint_error.recorded import Recorded, ReferenceMotion, recorded_errors

__all__ = [
    "COURSE_BIN_S",
    "ERROR_AXES",
    "ERROR_JOINTS",
    "ERROR_JOINTS_WITH_FINGERS",
    "Clipping",
    "JointErrorSummary",
    "Recorded",
    "ReferenceMotion",
    "active_times",
    "joint_error_course",
    "joint_error_summary",
    "joint_errors",
    "recorded_errors",
]
