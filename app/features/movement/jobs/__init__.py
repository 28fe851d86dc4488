"""Long jobs of the lab: the rows by which tunings and fits are ordered, stopped and resumed."""

from app.features.movement.jobs.service import MOST_AT_ONCE, JobKind

__all__ = ["MOST_AT_ONCE", "JobKind"]
