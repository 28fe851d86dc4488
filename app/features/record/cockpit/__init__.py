"""The operator's cockpit: views of sessions, commands, and live updates."""

from app.features.record.cockpit.schemas import LimbName, PhaseStatus
from app.features.record.cockpit.watching import router

__all__ = [
    "LimbName",
    "PhaseStatus",
    "router",
]
