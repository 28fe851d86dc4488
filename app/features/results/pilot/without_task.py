"""Where simulated people complete no task at all: a finding of a cohort, which no check makes."""

from collections.abc import Sequence
from typing import Final

from app.features.results.pilot.schemas import PhaseFigures, WithoutTask

MANY: Final = 0.25
"""The share of people without any task from which on that is a finding."""


def without_task(phases: Sequence[PhaseFigures]) -> list[WithoutTask]:
    """Return the limbs and latencies at which somebody completes no task, the most people first."""
    found = [
        WithoutTask(
            limb=one.limb,
            latency_ms=one.latency_ms,
            people=one.people,
            without=round(one.at_floor * one.people),
            is_many=one.at_floor >= MANY,
        )
        for one in phases
        if one.at_floor > 0.0
    ]
    return sorted(found, key=lambda one: -one.without / one.people)
