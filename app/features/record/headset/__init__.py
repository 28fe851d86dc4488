"""The headset of a session: its connection, the state it is sent, and its avatar."""

from app.features.record.headset.goals import feet_tracked, newest_goals, state_of_feet
from app.features.record.headset.poses import TOPICS, TOUCHES, Touch
from app.features.record.headset.service import headset_state, participant_info, worn_humanoid

__all__ = [
    "TOPICS",
    "TOUCHES",
    "Touch",
    "feet_tracked",
    "headset_state",
    "newest_goals",
    "participant_info",
    "state_of_feet",
    "worn_humanoid",
]
