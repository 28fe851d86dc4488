"""Turn the targets of a limb's parts so that each returns to its own direction in the world.

With joint targets a thigh that is pushed aside takes the shin with it: the knee keeps its angle,
and the leg feels like one stiff piece. With world targets the knee gives way, and the shin returns
to the direction that it would have if nothing had pushed.

For a part P of the limb and the part C attached to it, let D be the deviation of P, in its own
frame, from where its target is, seen from the chest or the hips, to which the limb is attached:

    D = (root_from_P target)^-1 (root_from_P actual).

C would keep its direction if its rotation were D^-1 R instead of R. With d the rotation vector of D
and e_i the direction, in the frame of P, of axis i of C at its target angles, the target angles
become

    q_i - e_i . d,

which does this to first order as far as C has axes for it: a knee cannot turn sideways. The
targets themselves are those of the participant throughout, so errors do not add up along the limb.

C's reaction on P arrives within a frame. An unfiltered d would make the limb swing, so d follows
the deviation with the time constant `YIELD_S`, slow compared with the motors and fast compared with
a person. Where nothing pushes, d is the small error of the motors.

The hips are where the participant's are, so a leg keeps its direction in the room. What pushes the
trunk aside is compensated at the shoulders (`following`).
"""

import math
from collections.abc import Collection
from typing import Final

import numpy as np

from app.science.avatar.body import AXES_OF, AXIS_NAMES
from app.science.rotations import (
    IDENTITY,
    FloatArray,
    Quaternion,
    Vector,
    q_inverse_multiply,
    q_multiply,
    q_rotate,
)

YIELD_S: Final = 0.1
_PARTS: Final = {
    "arm": ("UpperArm", "LowerArm", "Hand"),
    "leg": ("UpperLeg", "LowerLeg", "Foot", "Toes"),
}
_COLUMNS: Final = {name: column for column, name in enumerate(AXIS_NAMES)}
_TINY: Final = 1e-12
Turning = tuple[tuple[int, Vector], ...]


class LimbYield:
    """The deviations of some limbs' parts, and the targets that follow from them.

    Args:
        limbs: the limbs with world targets, such as `left_leg`.
    """

    def __init__(self, limbs: Collection[str]) -> None:
        self._limbs = [_chain(limb) for limb in limbs]
        self._deviations: list[list[Vector]] = []
        self.forget()

    def forget(self) -> None:
        """Forget all deviations: the body was put into a pose."""
        self._deviations = [[(0.0, 0.0, 0.0)] * (len(chain) - 1) for chain in self._limbs]

    def commands(self, targets_rad: FloatArray) -> FloatArray:
        """Return the angles to command: (91,) the targets, turned against the deviations."""
        commands = targets_rad.copy()
        for chain, deviations in zip(self._limbs, self._deviations, strict=True):
            for part, (dx, dy, dz) in zip(chain[1:], deviations, strict=True):
                turn = IDENTITY
                for column, direction in part:
                    x, y, z = q_rotate(turn, direction)
                    commands[column] -= x * dx + y * dy + z * dz
                    turn = q_multiply(turn, _about(direction, float(targets_rad[column])))
        return commands

    def note(self, targets_rad: FloatArray, actual_rad: FloatArray, elapsed_s: float) -> None:
        """Let the deviations follow the actual angles, which are NaN where there is no hinge."""
        share = 1.0 - math.exp(-elapsed_s / YIELD_S)
        actual = np.where(np.isnan(actual_rad), targets_rad, actual_rad).tolist()
        targets = targets_rad.tolist()
        for chain, deviations in zip(self._limbs, self._deviations, strict=True):
            wanted = found = IDENTITY
            for row, part in enumerate(chain[:-1]):
                wanted = q_multiply(wanted, _rotation(part, targets))
                found = q_multiply(found, _rotation(part, actual))
                now = _rotation_vector(q_inverse_multiply(wanted, found))
                x, y, z = (
                    old + share * (new - old) for old, new in zip(deviations[row], now, strict=True)
                )
                deviations[row] = (x, y, z)


def _chain(limb: str) -> tuple[Turning, ...]:
    """Return columns and directions of the axes of each part of a limb, from the body outwards."""
    side, _, kind = limb.partition("_")
    return tuple(
        tuple((_COLUMNS[axis.name], axis.direction) for axis in AXES_OF[side.title() + part])
        for part in _PARTS[kind]
    )


def _rotation(part: Turning, angles_rad: list[float]) -> Quaternion:
    turn = IDENTITY
    for column, direction in part:
        turn = q_multiply(turn, _about(direction, angles_rad[column]))
    return turn


def _about(direction: Vector, angle_rad: float) -> Quaternion:
    x, y, z = direction
    s = math.sin(angle_rad / 2.0)
    return math.cos(angle_rad / 2.0), s * x, s * y, s * z


def _rotation_vector(q: Quaternion) -> Vector:
    w, x, y, z = q
    length = math.sqrt(x * x + y * y + z * z)
    if length < _TINY:
        return 0.0, 0.0, 0.0
    # The shorter way round: q and -q are the same rotation.
    factor = 2.0 * math.atan2(length, abs(w)) / length * (-1.0 if w < 0.0 else 1.0)
    return factor * x, factor * y, factor * z
