"""Make an avatar follow one participant: convert each frame's pose to the motors' targets.

Targets have one of two meanings:

- `local`: each joint is driven to the participant's own joint angles. A trunk that something pushes
  aside takes arms and head with it, which then feel stiff: they keep their angle to the trunk.
- `world`: arms and head are driven to the orientation in the room that they would have if nothing
  pushed the trunk. With D the deviation of the upper chest, in its own frame, from its target,

      D = (hips_from_chest target)^-1 (hips_from_chest actual),
      chest_from_limb target = D^-1 (chest_from_limb of the participant).

  So a pushed trunk does not drag the hands along: shoulders and neck give way by as much as the
  trunk was turned. Legs are attached to the hips, which nothing pushes aside. Where nothing touches
  the trunk, D is the small error of the motors.

  The arms' reaction on the trunk arrives within a frame, so an unfiltered D would make the body
  oscillate with growing amplitude. D is low-pass filtered with the time constant `YIELD_S`, slow
  compared with the motors and fast compared with a person.

Limbs with world targets (`limb_yield`) give way part by part, in either target space.

The deviation is known once per frame and can only be compensated without delay, so in `world`, and
for limbs with world targets, the added latency is applied to the poses, in a buffer here
(`delay.DelayBuffer`), and not in the simulation. In all cases the hips are not delayed, and a
latency of zero passes the pose through.
"""

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from app.science.avatar.body import AXES
from app.science.avatar.configuration import TargetSpace
from app.science.avatar.simulation.simulation import AvatarState, PhysicsAvatar
from app.science.avatar.targets import Fingers, LimbYield, TargetAngles, Targets
from app.science.delay import DelayBuffer
from app.science.rotations import (
    IDENTITY,
    FloatArray,
    Quaternion,
    conjugate,
    identity,
    multiply,
    q_inverse_multiply,
    q_multiply,
    slerp,
)
from app.science.skeleton import JOINT_NAMES

YIELD_S = 0.1
_LIMBS = [JOINT_NAMES.index(name) for name in ("Neck", "LeftShoulder", "RightShoulder")]
_TRUNK = [
    (column, axis.direction)
    for column, axis in enumerate(AXES)
    if axis.part in {"Spine", "Chest", "UpperChest"}
]


@dataclass(frozen=True, eq=False)
class FollowedFrame:
    """The result of one frame: targets and the avatar's state.

    Attributes:
        targets: the targets of the participant's current pose in `local`; in `world` of the delayed
            and compensated pose, and with limbs that have world targets of the delayed pose.
        state: the avatar at the frame's time.
    """

    targets: Targets
    state: AvatarState


class Follower:
    """Feeds one participant's frames to one avatar.

    Args:
        avatar: the avatar, at its time zero or at rest.
        angles: the target angles, made with the limits and parts of the avatar's model.
        target_space: the meaning of the targets; see the module docstring.
        world_limbs: the limbs with world targets; see `limb_yield`.
        delay_s: the added latency; `set_delay` changes it.

    Raises:
        SimulationError, DelayError: an invalid delay.
    """

    def __init__(
        self,
        avatar: PhysicsAvatar,
        angles: TargetAngles,
        *,
        target_space: TargetSpace = "local",
        world_limbs: Collection[str] = (),
        delay_s: float = 0.0,
    ) -> None:
        self._avatar, self._angles = avatar, angles
        self._trunk_yields = target_space == "world"
        self._limbs = LimbYield(world_limbs) if world_limbs else None
        gives_way = self._trunk_yields or self._limbs is not None
        self._poses = DelayBuffer(0.0) if gives_way else None
        self._deviation: FloatArray = identity()
        self.set_delay(delay_s)

    def set_delay(self, delay_s: float) -> None:
        """Change the added latency from the next frame on; raises the same errors as the class."""
        if self._poses is None:
            self._avatar.switches.set_delay(delay_s)
        else:
            self._poses.set_delay(delay_s)

    def start(
        self,
        position_m: FloatArray,
        rotations: FloatArray,
        fingers: Fingers | None = None,
    ) -> None:
        """Put the avatar into a pose immediately: hips (3,), local rotations (22, 4), fingers."""
        self._angles.forget()
        angles = self._angles.follow(rotations, fingers).angles_rad
        self._avatar.start_at(position_m, rotations[0], angles)
        self._deviation = identity()
        if self._limbs is not None:
            self._limbs.forget()
        if self._poses is not None:
            self._poses.clear()

    def frame(
        self,
        time_s: float,
        position_m: FloatArray,
        rotations: FloatArray,
        fingers: Fingers | None = None,
    ) -> FollowedFrame:
        """Simulate the avatar up to the time of a frame.

        Args:
            time_s: later than the last frame's, on the avatar's clock.
            position_m: (3,) the participant's hips in the world.
            rotations: (22, 4) local rotations wxyz; row 0 is world_from_hips.
            fingers: the same as for `TargetAngles.follow`.

        Raises:
            SimulationError, TargetError, DelayError: an invalid time or shape.
        """
        pose = rotations
        if self._poses is not None:
            pose, fingers = self._delayed(self._poses, time_s, rotations, fingers)
            if self._trunk_yields:
                pose[_LIMBS] = multiply(conjugate(self._deviation), pose[_LIMBS])
        elapsed_s = max(time_s - self._avatar.time_s, 0.0)
        targets = self._angles.follow(pose, fingers)
        self._avatar.set_hips(position_m, rotations[0])
        commands = targets.angles_rad
        if self._limbs is not None:
            commands = self._limbs.commands(commands)
        self._avatar.set_targets(commands)
        self._avatar.step_to(time_s)
        state = self._avatar.state()
        if self._limbs is not None:
            self._limbs.note(targets.angles_rad, state.angles_rad, elapsed_s)
        if self._trunk_yields:
            now = _deviation(targets.angles_rad, state.angles_rad)
            self._deviation = slerp(self._deviation, now, 1.0 - math.exp(-elapsed_s / YIELD_S))
        return FollowedFrame(targets, state)

    @staticmethod
    def _delayed(
        poses: DelayBuffer,
        time_s: float,
        rotations: FloatArray,
        fingers: Fingers | None,
    ) -> tuple[FloatArray, Fingers | None]:
        """Return delayed copies of a body and its fingers, if these are given with every frame."""
        if fingers is None:
            return poses.push(time_s, rotations).copy(), None
        named = None if isinstance(fingers, np.ndarray) else tuple(fingers)
        given = fingers if isinstance(fingers, np.ndarray) else np.stack([*fingers.values()])
        delayed = poses.push(time_s, np.concatenate((rotations, given))).copy()
        body, late = delayed[: len(rotations)], delayed[len(rotations) :]
        return body, late if named is None else dict(zip(named, late, strict=True))


def _deviation(target_rad: FloatArray, actual_rad: FloatArray) -> FloatArray:
    target, actual = target_rad.tolist(), actual_rad.tolist()
    # Axes without a hinge count as at their target.
    actual = [t if math.isnan(a) else a for t, a in zip(target, actual, strict=True)]
    return np.array(q_inverse_multiply(_chest(target), _chest(actual)))


def _chest(angles: list[float]) -> Quaternion:
    """Return hips_from_chest at these angles."""
    turn = IDENTITY
    for column, (x, y, z) in _TRUNK:
        half = angles[column] / 2.0
        s = math.sin(half)
        turn = q_multiply(turn, (math.cos(half), s * x, s * y, s * z))
    return turn
