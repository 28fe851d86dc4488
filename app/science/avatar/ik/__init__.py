"""Inverse kinematics: compute the avatar's angles from tracked head, hands, waist and shins.

Loading this package loads MuJoCo.
"""

from app.science.avatar.ik.chain import Chain
from app.science.avatar.ik.goals import GOAL_PARTS, Goals, IkError, goals_of
from app.science.avatar.ik.solver import REST_POSE_RAD, InverseKinematics, Solution, Weights

__all__ = [
    "GOAL_PARTS",
    "REST_POSE_RAD",
    "Chain",
    "Goals",
    "IkError",
    "InverseKinematics",
    "Solution",
    "Weights",
    "goals_of",
]
