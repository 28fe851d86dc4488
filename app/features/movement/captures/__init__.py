"""Captures of movement: stored once, read, mapped, retargeted and verified.

Whatever computes runs on the `Workbench`, in a process of its own within limits of time and memory.
"""

from app.features.movement.captures.service import source_of_capture
from app.features.movement.captures.workbench import Workbench

__all__ = ["Workbench", "source_of_capture"]
