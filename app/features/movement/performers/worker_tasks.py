"""Write recordings, and open skeletons of captures; runs in the worker process for captures."""

from dataclasses import dataclass
from pathlib import Path

from app.adapters.captures import to_bvh
from app.features.movement.captures import Mapped
from app.features.movement.performers.recording import Gap, Recorded, at_constant_rate
from app.science.rig import Rig


@dataclass(frozen=True)
class Written:
    """What was written; `held_share` is the share of bones that were not observed."""

    frames: int
    rate_hz: float
    duration_s: float
    gaps: tuple[Gap, ...]
    held_share: float


def write_recording(recorded: Recorded, to: Path) -> Written:
    """Write a recording at a constant rate as a BVH file."""
    motion, gaps = at_constant_rate(recorded)
    to.write_text(to_bvh(motion), encoding="utf-8", newline="\n")
    held_share = 1.0 - float(motion.observed.mean())
    return Written(motion.frame_count, motion.rate_hz, motion.duration_s, gaps, held_share)


def skeleton_of(mapped: Mapped) -> Rig:
    """Return the skeleton of a capture, as a body to move; raises Cannot."""
    return mapped.moving.rig
