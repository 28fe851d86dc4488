"""A companion: a performer whom the participant sees in the headset as another person.

An experimenter chooses a live skeleton (`app.features.movement.performers`), a body and a place;
the headset says while the participant sees it, and what was shown meanwhile is stored.
"""

from app.features.record.companion.frames import ENCODING, ShownFrames, decode_frames
from app.features.record.companion.service import Companions

__all__ = ["ENCODING", "Companions", "ShownFrames", "decode_frames"]
