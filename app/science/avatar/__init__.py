"""The avatars: a body that follows the participant's with a chosen delay."""

from app.science.delay import DelayBuffer, DelayError, delayed_pose

__all__ = ["DelayBuffer", "DelayError", "delayed_pose"]
