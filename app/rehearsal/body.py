"""The rehearsing participant's body and movement."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.adapters.bvh import BvhError, read_bvh
from app.science.simulation import SimulatedParticipant, idle_movement
from app.science.skeleton import Skeleton, SkeletonError, build_skeleton
from app.science.skeleton.movement import Movement, loop, resample
from app.science.skeleton.retarget import retarget

FRAME_RATE_HZ = 90.0
# CMU's captures; only proportions matter, since a capture is scaled to the stature.
METRES_PER_BVH_UNIT = 0.056444


class CaptureError(ValueError):
    """The capture cannot be used as movement; says why and what to do."""


@dataclass(frozen=True)
class Person:
    """Who takes part in the rehearsal: made up from the seed, and simulated."""

    stature_m: float
    handedness: str
    footedness: str
    age: int
    skeleton: Skeleton
    participant: SimulatedParticipant


def make_person(rng: np.random.Generator, capture: Path | None) -> Person:
    """A person moving like `capture`, or by movement made here; raises CaptureError."""
    stature_m = float(np.clip(rng.normal(1.72, 0.09), 1.52, 1.95))
    skeleton = build_skeleton(stature_m)
    movement = idle_movement(skeleton, rng) if capture is None else _looped(capture, skeleton)
    return Person(
        stature_m=stature_m,
        handedness="left" if rng.random() < 0.1 else "right",
        footedness=str(rng.choice(["right", "left", "both"], p=[0.8, 0.1, 0.1])),
        age=int(rng.integers(19, 45)),
        skeleton=skeleton,
        participant=SimulatedParticipant(skeleton, movement, rng),
    )


def _looped(capture: Path, skeleton: Skeleton) -> Movement:
    """The capture in place, scaled to the stature, looped with a cross-fade."""
    try:
        clip = read_bvh(capture, metres_per_unit=METRES_PER_BVH_UNIT)
        return loop(resample(retarget(clip, skeleton), FRAME_RATE_HZ))
    except (BvhError, SkeletonError, OSError) as error:
        raise CaptureError(f"{capture} cannot be used: {error}") from error
