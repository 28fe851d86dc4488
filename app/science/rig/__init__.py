"""Model skeletons of any kind, markers and rigid bodies, and their movement."""

from app.science.rig.model import BoolArray, Rig, RigError, RigMotion, to_local, to_world
from app.science.rig.points import BodyMotion, MarkerMotion

__all__ = [
    "BodyMotion",
    "BoolArray",
    "MarkerMotion",
    "Rig",
    "RigError",
    "RigMotion",
    "to_local",
    "to_world",
]
