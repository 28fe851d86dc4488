"""Extract walks from captures and tracks.

`track_of_motion` extracts a person's track on the floor from a capture, `walks_of` cuts a track
into walks, and `entry_of` finds the path of each; `planned_walk` always takes the planned one.
`census` counts path lengths, `doubts_about` names what suggests another unit, and `extent_of` in
what somebody stood still.
"""

from app.science.walking.recording.capture_tracks import TrackingOptions, track_of_motion
from app.science.walking.recording.census import census
from app.science.walking.recording.plausibility import doubts_about, extent_of
from app.science.walking.recording.segmentation import (
    SegmentationRules,
    moving,
    rounds_of,
    smoothed,
    walks_of,
)
from app.science.walking.recording.tracks import Walker
from app.science.walking.recording.walks import (
    FASTEST_M_S,
    LeftOut,
    Recorded,
    dependencies_of,
    entry_of,
    planned_walk,
)

__all__ = [
    "FASTEST_M_S",
    "LeftOut",
    "Recorded",
    "SegmentationRules",
    "TrackingOptions",
    "Walker",
    "census",
    "dependencies_of",
    "doubts_about",
    "entry_of",
    "extent_of",
    "moving",
    "planned_walk",
    "rounds_of",
    "smoothed",
    "track_of_motion",
    "walks_of",
]
