"""Live tracking: doors through which other software sends trackers, and the state of its sources.

Doors are closed until somebody opens them. What arrives is watched and shown; it is not recorded.
"""

from app.features.movement.live.service import LiveTracking

__all__ = ["LiveTracking"]
