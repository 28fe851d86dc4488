"""What operators see of sessions and what they order: views, commands, live news."""

from app.features.record.cockpit.schemas import LimbName, PhaseStatus
from app.features.record.cockpit.watching import router

__all__ = [
    "LimbName",
    "PhaseStatus",
    "router",
]
