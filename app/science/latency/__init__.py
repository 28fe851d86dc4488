"""Measure the latency that a participant really had, from the two recorded streams.

`latency_of_runs` returns the delay of the avatar, its confidence interval, and the reason where it
cannot be determined; `is_off` compares it with the set latency.
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
