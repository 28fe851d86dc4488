"""Replay a recorded phase: the movement, and the events in step with it.

The `ReplayDesk` computes the movement, one phase at a time.
"""

from app.features.results.replay.desk import ReplayDesk

__all__ = ["ReplayDesk"]
