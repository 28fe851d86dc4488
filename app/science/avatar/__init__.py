"""The avatars: a body that follows the participant's with a chosen delay."""

from app.science.avatar.simulation.delay import DelayBuffer, DelayError, delayed_pose

__all__ = ["DelayBuffer", "DelayError", "delayed_pose"]
