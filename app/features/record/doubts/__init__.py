"""Doubts: contradictions in a session's record, which show that reported data cannot be true."""

from app.features.record.doubts.laws import KINDS, Doubt, exceeds_possible
from app.features.record.doubts.service import (
    OBSERVED,
    doubts_of,
    doubts_of_sessions,
    judge_with_doubts,
)

__all__ = [
    "KINDS",
    "OBSERVED",
    "Doubt",
    "doubts_of",
    "doubts_of_sessions",
    "exceeds_possible",
    "judge_with_doubts",
]
