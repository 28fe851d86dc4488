"""Captures of movement: stored once, parsed, mapped, retargeted and verified.

All computing runs on the `CaptureQueue`, in a worker process with limits of time and memory.
"""

from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.service import source_of_capture

__all__ = ["CaptureQueue", "source_of_capture"]
