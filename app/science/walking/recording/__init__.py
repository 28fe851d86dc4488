"""Extract walks from captures and tracks.

`track_of_motion` extracts a person's track on the floor from a capture, `walks_of` cuts a track
into walks and `planned_walk` plans a path for each; `census` counts path lengths.
"""

from app.science.walking.recording.capture_tracks import TrackingOptions, track_of_motion
from app.science.walking.recording.census import census
from app.science.walking.recording.segmentation import walks_of
from app.science.walking.recording.tracks import Walker
from app.science.walking.recording.walks import dependencies_of, planned_walk

__all__ = [
    "TrackingOptions",
    "Walker",
    "census",
    "dependencies_of",
    "planned_walk",
    "track_of_motion",
    "walks_of",
]
