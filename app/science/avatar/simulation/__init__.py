"""Simulate the avatar: its state, contacts and switches.

`PhysicsAvatar` steps one loaded model; `Follower` makes it follow a participant's poses, and
`SurfaceTouches` reports which boxes it touches. Creating a `PhysicsAvatar` loads MuJoCo and the
compiler.
"""

from app.science.avatar.simulation.contacts import Contact
from app.science.avatar.simulation.following import Follower
from app.science.avatar.simulation.simulation import MAX_SPEED_RAD_S, PhysicsAvatar
from app.science.avatar.simulation.touches import SurfaceTouches

__all__ = [
    "MAX_SPEED_RAD_S",
    "Contact",
    "Follower",
    "PhysicsAvatar",
    "SurfaceTouches",
]
