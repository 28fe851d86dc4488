"""Pilot: what a planned study would find if people were as its assumptions say."""

from app.features.results.pilot.plan import (
    Chunk,
    PilotError,
    PilotPlan,
    Scenario,
    chunks_of,
    lowest_p,
    make_plan,
    most_participants,
)
from app.features.results.pilot.simulated_study import SimulatedStudy

__all__ = [
    "Chunk",
    "PilotError",
    "PilotPlan",
    "Scenario",
    "SimulatedStudy",
    "chunks_of",
    "lowest_p",
    "make_plan",
    "most_participants",
]
