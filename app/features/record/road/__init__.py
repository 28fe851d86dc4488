"""The study's road in a session: its scene runs while the participant crosses, and is recorded.

The headset says where the participant is at each step of the scene; the server lets cars and
walkers advance and says where they are. `Roads` keeps the scenes that run.
"""

from app.features.record.road.recording import record_of
from app.features.record.road.service import Roads, missing_for

__all__ = ["Roads", "missing_for", "record_of"]
