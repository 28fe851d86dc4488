"""The lab's trackers in a session: in the headset's world, on the record, and stored as they came.

A person chooses a source that sends through the doors (`app.features.movement.live`). One of its
trackers is fixed to the headset; the wearer looks around, and `app.science.alignment` finds how the
worlds lie.
"""

from app.features.record.lab_trackers.link import FOOT_LIMIT_M
from app.features.record.lab_trackers.recording import next_number
from app.features.record.lab_trackers.samples import ENCODING, TrackerSamples, decode_samples
from app.features.record.lab_trackers.service import LabTrackers

__all__ = [
    "ENCODING",
    "FOOT_LIMIT_M",
    "LabTrackers",
    "TrackerSamples",
    "decode_samples",
    "next_number",
]
