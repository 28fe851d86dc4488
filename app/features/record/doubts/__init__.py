"""What of a session's record cannot be true, and so is never believed."""

from app.features.record.doubts.laws import KINDS, Doubt, beyond_reason
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
    "beyond_reason",
    "doubts_of",
    "doubts_of_sessions",
    "judge_with_doubts",
]
