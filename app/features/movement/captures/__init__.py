"""Captures of movement: stored once, parsed, mapped, retargeted and verified.

All computing runs on the `CaptureQueue`, in a worker process with limits of time and memory.
"""

from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.joint_maps import mapped_capture
from app.features.movement.captures.opening import Mapped
from app.features.movement.captures.service import source_of_capture
from app.features.movement.captures.source import Cannot

__all__ = ["Cannot", "CaptureQueue", "Mapped", "mapped_capture", "source_of_capture"]
