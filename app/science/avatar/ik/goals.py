"""Define the goals of inverse kinematics: the poses of a body's tracked parts at one moment.

A goal is the position of a part's joint and the part's orientation in the world (x right, y up; in
the T-pose, facing -z, every part's frame is parallel to the world). The offset between a tracker
and the joint of the part that wears it is calibrated beforehand, where the tracker is read.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

GOAL_PARTS: tuple[str, ...] = (
    "Hips", "Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg",
)  # fmt: skip
"""The parts that can be tracked, in the order of a goal's rows; the waist tracker is the hips'."""
HIPS, HEAD = 0, 1
LEFT_SHIN, RIGHT_SHIN = 4, 5
_COUNT = len(GOAL_PARTS)
_UNIT_WITHIN = 1e-3


class IkError(ValueError):
    """Goals or a model are unsuitable for inverse kinematics."""


@dataclass(frozen=True, eq=False)
class Goals:
    """Poses of the tracked parts in the world, in the order of `GOAL_PARTS`.

    Attributes:
        positions_m: (6, 3) positions of the parts' joints.
        rotations: (6, 4) wxyz, world_from_part, unit.
        tracked: (6,) whether each part is tracked at this moment; rows of the others are not read.

    Raises:
        IkError: a wrong shape, a number that is not finite, or a quaternion that is not unit.
    """

    positions_m: FloatArray
    rotations: FloatArray
    tracked: npt.NDArray[np.bool_]

    def __post_init__(self) -> None:
        for name, shape in (("positions_m", (_COUNT, 3)), ("rotations", (_COUNT, 4))):
            found = getattr(self, name).shape
            if found != shape:
                raise IkError(f"Goals need {name} of shape {shape}, not {found}.")
        if self.tracked.shape != (_COUNT,):
            raise IkError(f"Goals need {_COUNT} values of tracked, not {self.tracked.shape}.")
        for row in np.flatnonzero(self.tracked).tolist():
            _check(GOAL_PARTS[row], self.positions_m[row], self.rotations[row])


def goals_of(
    poses: Mapping[str, tuple[Sequence[float] | FloatArray, Sequence[float] | FloatArray]],
) -> Goals:
    """Return goals from part -> (position in metres, rotation wxyz); absent parts are not tracked.

    Raises:
        IkError: a part that cannot be tracked, or an invalid value as for `Goals`.
    """
    positions, rotations = np.zeros((_COUNT, 3)), np.zeros((_COUNT, 4))
    tracked = np.zeros(_COUNT, dtype=np.bool_)
    for part, (position, rotation) in poses.items():
        if part not in GOAL_PARTS:
            raise IkError(f"{part!r} is not a tracked part: give some of {', '.join(GOAL_PARTS)}.")
        row = GOAL_PARTS.index(part)
        if len(position) != 3 or len(rotation) != 4:
            raise IkError(f"{part}: give a position of 3 numbers and a rotation of 4 (wxyz).")
        positions[row], rotations[row], tracked[row] = position, rotation, True
    return Goals(positions, rotations, tracked)


def _check(part: str, position: FloatArray, rotation: FloatArray) -> None:
    if not np.isfinite(position).all():
        raise IkError(
            f"The goal of {part} lies at {position.tolist()}: mark a part as not tracked if its"
            " position is unknown."
        )
    norm = float(np.sqrt(rotation @ rotation))
    if not abs(norm - 1.0) <= _UNIT_WITHIN:
        raise IkError(
            f"The rotation of {part}, {rotation.tolist()}, is not a unit quaternion (w, x, y, z):"
            f" its length is {norm:g}, not 1."
        )
