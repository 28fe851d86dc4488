"""The agent that follows a path, steered by three parameters, and metrics of its walk.

`SteeringFollower` moves one agent for each vector of parameters; `EuclideanMetric` is the paper's.
The compiler is loaded with the first agent.
"""

from app.science.walking.following.course import course_of
from app.science.walking.following.following import FollowingRules, SteeringFollower
from app.science.walking.following.metrics import EuclideanMetric

__all__ = [
    "EuclideanMetric",
    "FollowingRules",
    "SteeringFollower",
    "course_of",
]
