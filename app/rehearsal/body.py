"""The simulated participant's body and movement, either synthetic or from a capture."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.adapters.captures import CaptureError, read_capture_file
from app.errors import file_problem
from app.science.retargeting import movement_in_place, propose_joint_map
from app.science.rig import RigError, RigMotion
from app.science.simulation import (
    SimulatedFingers,
    SimulatedParticipant,
    idle_movement,
    pointing,
)
from app.science.skeleton import Movement, Skeleton, SkeletonError, build_skeleton, loop, resample

FRAME_RATE_HZ = 90.0
CROSSFADE_S, SHORTEST_CROSSFADE_S = 0.4, 0.1
SHORTEST_LOOP_S = 0.55
"""Shortest loop: a capture of a second is long enough, with a shorter cross-fade."""


class UnusableCapture(ValueError):
    """The capture cannot be used as movement; the message says why and what to do."""


def captured_movement(path: Path, skeleton: Skeleton) -> Movement:
    """Return the capture's movement on a skeleton, in place and facing -z.

    A skeleton is first fitted to markers.

    Raises:
        UnusableCapture: the file cannot be read, or its movement cannot be transferred to a body.
    """
    try:
        source = skeleton_motion(path)
        joint_map = propose_joint_map(source.rig).joint_map
        return movement_in_place(source, joint_map, skeleton)
    except OSError as error:
        raise UnusableCapture(file_problem(error)) from error
    except (CaptureError, RigError, SkeletonError) as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error


def skeleton_motion(path: Path) -> RigMotion:
    """Return the movement of the capture's own skeleton, or of one fitted to its markers or bodies.

    Raises:
        UnusableCapture: no skeleton can be fitted.
        CaptureError, OSError: see `read_capture_file`.
    """
    motion = read_capture_file(path).motion
    if isinstance(motion, RigMotion):
        return motion
    from app.science.fitting import FitError, fit_skeleton  # most captures have a skeleton

    try:
        return fit_skeleton(motion).motion
    except FitError as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error


@dataclass(frozen=True)
class Person:
    """The simulated participant of a rehearsal, with properties drawn from the seed.

    `fingers`: their generated movement; None if fingers are not recorded.
    """

    stature_m: float
    handedness: str
    footedness: str
    age: int
    skeleton: Skeleton
    participant: SimulatedParticipant
    fingers: SimulatedFingers | None = None


def make_person(
    rng: np.random.Generator, capture: Path | None, *, with_fingers: bool = False
) -> Person:
    """Make a participant that moves like `capture`, or synthetically; raise UnusableCapture.

    `with_fingers`: with generated movement of the fingers, and an index finger that points.
    """
    stature_m = float(np.clip(rng.normal(1.72, 0.09), 1.52, 1.95))
    skeleton = build_skeleton(stature_m)
    movement = idle_movement(skeleton, rng) if capture is None else _looped(capture, skeleton)
    person = Person(
        stature_m=stature_m,
        handedness="left" if rng.random() < 0.1 else "right",
        footedness=str(rng.choice(["right", "left", "both"], p=[0.8, 0.1, 0.1])),
        age=int(rng.integers(19, 45)),
        skeleton=skeleton,
        participant=SimulatedParticipant(
            pointing(skeleton) if with_fingers else skeleton, movement, rng
        ),
    )
    # Fingers have randomness of their own, so that a person moves the same with and without them.
    own = np.random.default_rng(rng.bit_generator.random_raw() if with_fingers else 0)
    return replace(person, fingers=SimulatedFingers(own)) if with_fingers else person


def _looped(capture: Path, skeleton: Skeleton) -> Movement:
    """Return the capture in place, scaled to the stature, and looped with a cross-fade."""
    movement = captured_movement(capture, skeleton)
    try:
        crossfade_s = min(CROSSFADE_S, (movement.duration_s - SHORTEST_LOOP_S) / 2.0)
        return loop(resample(movement, FRAME_RATE_HZ), max(crossfade_s, SHORTEST_CROSSFADE_S))
    except SkeletonError as error:
        raise UnusableCapture(f"{capture} cannot be used: {error}") from error
