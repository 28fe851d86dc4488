"""Pilots: what a planned study would find if people were as assumed, and what would break it.

A pilot runs in a worker process of its own (`PilotQueue`), which can be stopped and resumed, and
waits while somebody is in a session. What it computes is in `simulation`, which the command `pilot`
uses as well; the server does not load that.
"""

from app.features.results.pilot.example import example_assumptions
from app.features.results.pilot.pilot_queue import PilotQueue

__all__ = ["PilotQueue", "example_assumptions"]
