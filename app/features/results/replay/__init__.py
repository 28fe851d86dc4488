"""Replay a recorded phase: the movement, and the events in step with it.

The `ReplayQueue` computes the movement, one phase at a time.
"""

from app.features.results.replay.replay_queue import ReplayQueue

__all__ = ["ReplayQueue"]
