"""An avatar that follows one participant: from each frame's pose to the motors' targets.

Targets are meant in one of two ways:

- `local`: each joint is driven to the participant's own joint angles. A trunk that something pushes
  aside takes arms and head with it, which then feel stiff: they keep their angle to the trunk.
- `world`: arms and head are driven to the orientation in the room that they would have if nothing
  pushed the trunk. With D the deviation of the upper chest, in its own frame, from where the motors
  want it,

      D = (hips_from_chest wanted)^-1 (hips_from_chest actual),
      chest_from_limb asked for = D^-1 (chest_from_limb of the participant).

  So a pushed trunk does not drag the hands: shoulders and neck give way by as much as the trunk was
  turned. Legs hang on the hips, which nothing pushes aside. Where nothing touches, D is the small
  error of the motors.

  What an arm does pushes back on the trunk within a frame, so a D that is used as it comes makes
  the body swing itself up. It is followed with the time constant `YIELD_S`, slow against the motors
  and fast against a person.

The deviation is known once a frame and can only be acted upon without delay, so in `world` the
added latency is kept in a buffer of poses here (`delay.DelayBuffer`) and not in the simulation. In
both ways the hips are not delayed, and zero hands the pose through.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.science.avatar.body import AXES
from app.science.avatar.configuration import TargetSpace
from app.science.avatar.simulation.simulation import AvatarState, PhysicsAvatar
from app.science.avatar.targets import TargetAngles, Targets
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
    """One frame of the avatar.

    Attributes:
        targets: of the participant's present pose in `local`; in `world` of the delayed pose, as
            asked for.
        state: the avatar at the frame's time.
    """

    targets: Targets
    state: AvatarState


class Follower:
    """Feeds one participant's frames to one avatar.

    Args:
        avatar: at its time zero, or at rest.
        angles: made with the limits and parts of the avatar's model.
        target_space: see the module.
        delay_s: added latency; `set_delay` changes it.

    Raises:
        SimulationError, DelayError: a delay that cannot be.
    """

    def __init__(
        self,
        avatar: PhysicsAvatar,
        angles: TargetAngles,
        *,
        target_space: TargetSpace = "local",
        delay_s: float = 0.0,
    ) -> None:
        self._avatar, self._angles = avatar, angles
        self._poses = DelayBuffer(0.0) if target_space == "world" else None
        self._deviation: FloatArray = identity()
        self.set_delay(delay_s)

    def set_delay(self, delay_s: float) -> None:
        """Change the added latency from the next frame on; errors as for the class."""
        if self._poses is None:
            self._avatar.switches.set_delay(delay_s)
        else:
            self._poses.set_delay(delay_s)

    def start(self, position_m: FloatArray, rotations: FloatArray) -> None:
        """Put the avatar into a pose at once: hips (3,), local rotations (22, 4)."""
        self._angles.forget()
        angles = self._angles.follow(rotations).angles_rad
        self._avatar.start_at(position_m, rotations[0], angles)
        self._deviation = identity()

    def frame(
        self,
        time_s: float,
        position_m: FloatArray,
        rotations: FloatArray,
        fingers: Mapping[str, FloatArray] | None = None,
    ) -> FollowedFrame:
        """Bring the avatar to the time of a frame.

        Args:
            time_s: after the last frame's, on the avatar's clock.
            position_m: (3,) the participant's hips in the world.
            rotations: (22, 4) local rotations wxyz; row 0 is world_from_hips.
            fingers: as for `TargetAngles.follow`.

        Raises:
            SimulationError, TargetError, DelayError: times or shapes that do not fit.
        """
        asked = rotations if self._poses is None else self._poses.push(time_s, rotations)
        if self._poses is not None:
            asked = asked.copy()
            asked[_LIMBS] = multiply(conjugate(self._deviation), asked[_LIMBS])
        passed_s = max(time_s - self._avatar.time_s, 0.0)
        targets = self._angles.follow(asked, fingers)
        self._avatar.set_hips(position_m, rotations[0])
        self._avatar.set_targets(targets.angles_rad)
        self._avatar.step_to(time_s)
        state = self._avatar.state()
        if self._poses is not None:
            now = _deviation(targets.angles_rad, state.angles_rad)
            self._deviation = slerp(self._deviation, now, 1.0 - math.exp(-passed_s / YIELD_S))
        return FollowedFrame(targets, state)


def _deviation(unclamped_rad: FloatArray, actual_rad: FloatArray) -> FloatArray:
    wanted, actual = unclamped_rad.tolist(), actual_rad.tolist()
    # What has no hinge is where it is wanted.
    actual = [w if math.isnan(a) else a for w, a in zip(wanted, actual, strict=True)]
    return np.array(q_inverse_multiply(_chest(wanted), _chest(actual)))


def _chest(angles: list[float]) -> Quaternion:
    """hips_from_chest."""
    turn = IDENTITY
    for column, (x, y, z) in _TRUNK:
        half = angles[column] / 2.0
        s = math.sin(half)
        turn = q_multiply(turn, (math.cos(half), s * x, s * y, s * z))
    return turn
