"""Captures of movement: stored once, parsed, mapped, retargeted and verified.

All computing runs on the `Workbench`, in a worker process with limits of time and memory.
"""

from app.features.movement.captures.service import source_of_capture
from app.features.movement.captures.workbench import Workbench

__all__ = ["Workbench", "source_of_capture"]
