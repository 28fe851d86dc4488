"""Live tracking: doors through which other software sends trackers, and the state of its sources.

Doors are closed until somebody opens them. What arrives is watched and shown; other features follow
it, such as for a session's headset.
"""

from app.features.movement.live.service import LiveTracking, limbs_of
from app.features.movement.live.sources import (
    FORGOTTEN_S,
    SILENT_S,
    DoorKey,
    Sample,
    SourceClock,
)

__all__ = [
    "FORGOTTEN_S",
    "SILENT_S",
    "DoorKey",
    "LiveTracking",
    "Sample",
    "SourceClock",
    "limbs_of",
]
