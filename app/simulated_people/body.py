"""The simulated participant's body and movement, either synthetic or from a capture."""

import logging
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from app.adapters.captures import CaptureError, read_capture_file
from app.errors import file_problem
from app.science.anatomy import Notice, sentences
from app.science.retargeting import (
    captured_fingers,
    checked_skeleton,
    has_fingers,
    movement_in_place,
    propose_joint_map,
)
from app.science.rig import RigError, RigMotion
from app.science.rotations import FloatArray
from app.science.simulation import (
    Build,
    LoopedFingers,
    MovementTraits,
    ReachingPeople,
    SimulatedFingers,
    SimulatedParticipant,
    draw_build,
    draw_traits,
    idle_movement,
    pointing,
)
from app.science.skeleton import (
    JOINT_COUNT,
    Movement,
    Skeleton,
    SkeletonError,
    build_skeleton,
    continuous,
    loop,
    resample,
)
from app.science.tasks import Laterality

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
    return _captured(path, skeleton)[0]


def _captured(path: Path, skeleton: Skeleton) -> tuple[Movement, FloatArray | None]:
    """Return the capture's movement and that of its fingers (N, 30, 4), None if it has none."""
    try:
        source = skeleton_motion(path)
        joint_map = propose_joint_map(source.rig).joint_map
        movement = movement_in_place(source, joint_map, skeleton)
        fingers = (
            captured_fingers(source, joint_map) if has_fingers(source.rig, joint_map) else None
        )
        return movement, fingers
    except OSError as error:
        raise UnusableCapture(file_problem(error)) from error
    except (CaptureError, RigError, SkeletonError) as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error


def skeleton_motion(path: Path) -> RigMotion:
    """Return the movement of the capture's own skeleton, or of one fitted to its markers or bodies.

    A skeleton that is mirrored or upside down is mended (`checked_skeleton`). What anatomy finds is
    logged as a warning, once for each finding.

    Raises:
        UnusableCapture: no skeleton can be fitted.
        CaptureError, OSError: see `read_capture_file`.
    """
    motion = read_capture_file(path).motion
    if isinstance(motion, RigMotion):
        skeleton, notices = checked_skeleton(motion, propose_joint_map(motion.rig).joint_map)
        _warn(path, notices)
        return skeleton
    from app.science.fitting import FitError, fit_skeleton  # most captures have a skeleton

    try:
        fitted = fit_skeleton(motion)
    except FitError as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error
    _warn(path, fitted.notices)
    return fitted.motion


def _warn(path: Path, notices: tuple[Notice, ...]) -> None:
    for sentence in sentences(notices):
        _warn_once(f"{path.name}: {sentence}")


@cache
def _warn_once(text: str) -> None:
    logging.getLogger(__name__).warning("%s", text)


@dataclass(frozen=True)
class Person:
    """The simulated participant of a rehearsal or a pilot, with properties drawn from the seed.

    `fingers`: their movement, from the capture or generated; None if they are not recorded.
    """

    build: Build
    skeleton: Skeleton
    participant: SimulatedParticipant
    fingers: SimulatedFingers | LoopedFingers | None = None

    @property
    def stature_m(self) -> float:
        """The stature in metres."""
        return self.build.stature_m

    @property
    def handedness(self) -> str:
        """The writing hand."""
        return self.build.handedness

    @property
    def leading_foot(self) -> Laterality:
        """The foot that steps first: the right one if none is preferred."""
        foot = self.build.footedness
        return Laterality.RIGHT if foot == "both" else Laterality(foot)


def make_person(
    rng: np.random.Generator,
    capture: Path | None,
    *,
    with_fingers: bool = False,
    reaching: ReachingPeople | None = None,
) -> Person:
    """Make a participant that moves like `capture`, or synthetically; raise UnusableCapture.

    `with_fingers`: with the fingers of the capture or, if it has none, generated ones, and an index
    finger that points. `reaching`: how people reach, as recorded ones do; None for the constants.
    """
    build = draw_build(rng)
    skeleton = build_skeleton(build.stature_m)
    fingers: FloatArray | None = None
    if capture is None:
        movement = idle_movement(skeleton, rng)
    else:
        movement, fingers = _looped(capture, skeleton, with_fingers=with_fingers)
    person = Person(
        build=build,
        skeleton=skeleton,
        participant=SimulatedParticipant(
            pointing(skeleton) if with_fingers else skeleton,
            movement,
            rng,
            traits=None if reaching is None else _reaching_traits(reaching, rng),
        ),
    )
    if not with_fingers:
        return person
    if fingers is not None:
        offset_s = person.participant.base_offset_s
        return replace(person, fingers=LoopedFingers(fingers, FRAME_RATE_HZ, offset_s))
    # A generator of their own, so that a person's body moves the same with and without fingers.
    return replace(person, fingers=SimulatedFingers(rng.spawn(1)[0]))


def _reaching_traits(reaching: ReachingPeople, rng: np.random.Generator) -> MovementTraits:
    """Draw traits of somebody who reaches as recorded people do."""
    return replace(draw_traits(rng), reaching=reaching.person(rng))


def _looped(
    capture: Path, skeleton: Skeleton, *, with_fingers: bool
) -> tuple[Movement, FloatArray | None]:
    """Return the capture in place, scaled to the stature, and looped with a cross-fade.

    With its fingers (N, 30, 4) if they are asked for and it has any; else None.
    """
    movement, fingers = _captured(capture, skeleton)
    if with_fingers and fingers is not None:
        movement = replace(
            movement, rotations=np.concatenate((movement.rotations, continuous(fingers)), axis=1)
        )
    try:
        crossfade_s = min(CROSSFADE_S, (movement.duration_s - SHORTEST_LOOP_S) / 2.0)
        whole = loop(resample(movement, FRAME_RATE_HZ), max(crossfade_s, SHORTEST_CROSSFADE_S))
    except SkeletonError as error:
        raise UnusableCapture(f"{capture} cannot be used: {error}") from error
    body = replace(whole, rotations=whole.rotations[:, :JOINT_COUNT])
    looped = whole.rotations[:, JOINT_COUNT:]
    return body, looped if looped.shape[1] else None
