"""A phase looked at again: what moved, and what happened in step with it.

Movement is placed by the `ReplayDesk`, one phase at a time.
"""

from app.features.results.replay.desk import ReplayDesk

__all__ = ["ReplayDesk"]
