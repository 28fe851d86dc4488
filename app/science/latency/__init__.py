"""The latency that a participant really got, found from the two recorded streams.

`latency_of_runs` says how late the avatar was, how sure that is, and why it is not known where it
is not; `is_off` compares it with the ordered one.
"""

from app.science.latency.achieved_latency import (
    HIGHEST_S,
    AchievedLatency,
    StreamPair,
    achieved_latency,
    is_off,
    latency_of_runs,
)

__all__ = [
    "HIGHEST_S",
    "AchievedLatency",
    "StreamPair",
    "achieved_latency",
    "is_off",
    "latency_of_runs",
]
