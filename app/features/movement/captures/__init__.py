"""Captures of movement: stored once, parsed, mapped, retargeted and verified.

All computing runs on the `CaptureQueue`, in a worker process with limits of time and memory.
"""

from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.joint_maps import CurrentMap, map_of_rig, mapped_capture
from app.features.movement.captures.opening import Mapped
from app.features.movement.captures.schemas import AVATAR, ReadingChoice
from app.features.movement.captures.service import UploadOptions, add_capture, source_of_capture
from app.features.movement.captures.source import Cannot

__all__ = [
    "AVATAR",
    "Cannot",
    "CaptureQueue",
    "CurrentMap",
    "Mapped",
    "ReadingChoice",
    "UploadOptions",
    "add_capture",
    "map_of_rig",
    "mapped_capture",
    "source_of_capture",
]
