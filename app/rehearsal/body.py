"""The rehearsing participant's body and movement."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.rehearsal.captured import UnusableCapture, captured_movement
from app.science.simulation import SimulatedParticipant, idle_movement
from app.science.skeleton import Movement, Skeleton, SkeletonError, build_skeleton, loop, resample

FRAME_RATE_HZ = 90.0
CROSSFADE_S, SHORTEST_CROSSFADE_S = 0.4, 0.1
SHORTEST_LOOP_S = 0.55
"""A capture of a second still makes a loop, with a shorter cross-fade."""


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
    """A person moving like `capture`, or by movement made here; raises UnusableCapture."""
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
    movement = captured_movement(capture, skeleton)
    try:
        crossfade_s = min(CROSSFADE_S, (movement.duration_s - SHORTEST_LOOP_S) / 2.0)
        return loop(resample(movement, FRAME_RATE_HZ), max(crossfade_s, SHORTEST_CROSSFADE_S))
    except SkeletonError as error:
        raise UnusableCapture(f"{capture} cannot be used: {error}") from error
