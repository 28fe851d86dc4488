"""Performers: skeletons that come live through the doors, watched on bodies and recorded.

Any skeleton that a source sends, by VMC, NatNet or JSON, becomes frames of one rig, which are
retargeted to a body for each page that watches, and can be recorded as a capture.
"""

from app.features.movement.performers.assembly import Assembly, BodyFrame, skeletons_in
from app.features.movement.performers.on_body import OnBody, reference_body
from app.features.movement.performers.performer import Agreed, Performer, PerformerName
from app.features.movement.performers.schemas import BodyState, PerformerWish
from app.features.movement.performers.service import Performers
from app.features.movement.performers.views import body_state, joint_map_of

__all__ = [
    "Agreed",
    "Assembly",
    "BodyFrame",
    "BodyState",
    "OnBody",
    "Performer",
    "PerformerName",
    "PerformerWish",
    "Performers",
    "body_state",
    "joint_map_of",
    "reference_body",
    "skeletons_in",
]
