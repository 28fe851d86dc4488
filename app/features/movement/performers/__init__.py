"""Performers: skeletons that come live through the doors, watched on bodies and recorded.

Any skeleton that a source sends, by VMC, NatNet or JSON, becomes frames of one rig, which are
retargeted to a body for each page that watches, and can be recorded as a capture.
"""

from app.features.movement.performers.service import Performers

__all__ = ["Performers"]
