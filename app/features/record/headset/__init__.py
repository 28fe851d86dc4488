"""The headset of a session: its connection, the state it is sent, and its avatar."""

from app.features.record.headset.avatar import SessionAvatar, trial_avatar
from app.features.record.headset.connection import next_message, next_of, until_one_ends
from app.features.record.headset.further_socket import FurtherSocket
from app.features.record.headset.goals import (
    calibration_underway,
    feet_tracked,
    newest_goals,
    state_of_feet,
)
from app.features.record.headset.kept_movement import Waiting, is_kept, recording_of
from app.features.record.headset.poses import TOPICS, TOUCHES, Touch
from app.features.record.headset.service import (
    headset_state,
    is_recording,
    participant_info,
    worn_humanoid,
)
from app.features.record.headset.serving import serve_headset

__all__ = [
    "TOPICS",
    "TOUCHES",
    "FurtherSocket",
    "SessionAvatar",
    "Touch",
    "Waiting",
    "calibration_underway",
    "feet_tracked",
    "headset_state",
    "is_kept",
    "is_recording",
    "newest_goals",
    "next_message",
    "next_of",
    "participant_info",
    "recording_of",
    "serve_headset",
    "state_of_feet",
    "trial_avatar",
    "until_one_ends",
    "worn_humanoid",
]
