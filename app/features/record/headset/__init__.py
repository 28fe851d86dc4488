"""The headset of a session: its connection, the state it is sent, and its avatar."""

from app.features.record.headset.poses import TOPICS, TOUCHES, Touch
from app.features.record.headset.service import headset_state, participant_info, worn_humanoid

__all__ = [
    "TOPICS",
    "TOUCHES",
    "Touch",
    "headset_state",
    "participant_info",
    "worn_humanoid",
]
