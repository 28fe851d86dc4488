"""Solve inverse kinematics by damped least squares, on the model that is simulated.

The unknowns are the hinge angles q that bring the tracked parts to their goals. With e_g the goal's
error of position (metres) and of rotation (rotation vector from the part to its goal, radians),
both in the world, and J_g the part's Jacobian (MuJoCo's `mj_jacBody`), a step x from q minimises

    sum over goals and both kinds  w^2 |J_g x - e_g|^2
        + w_rest^2 |q + x - q_rest|^2  +  |D x|^2     with  low <= q + x <= high,

whose normal equations are

    (J' W^2 J + w_rest^2 I + D^2) x = J' W^2 e + w_rest^2 (q_rest - q).

The rest pose decides what the goals leave open (there are 41 angles and 30 numbers to reach). The
damping D^2 = CALM + DAMPING E is diagonal: E, for each angle, is the squared weighted error of the
goals that it moves. It steadies limbs that stretch towards goals out of reach, and errors of one
limb do not slow the others; the constant, ten times the weight of the rest pose, lets angles that
the goals leave open return to rest over several frames instead of in one. Neither changes the
solution. The step itself respects the limits, so the other joints compensate (see `bounded_step`).

Two steps per frame, each frame starting where the last one ended, are enough to follow a moving
person. An angle that moves no tracked goal stays where it is, so a limb whose tracker is lost keeps
its pose.

The hips are where the waist tracker is. Without one their position and orientation are six more
unknowns, drawn to the estimate of `hips` with the weight of the rest pose. They start at the
estimate, and restart there if the distance is larger than its error can be, as after a teleport.
With neither waist nor head tracked they stay.

Source: Wampler (1986), IEEE Trans. SMC 16(1), 93-101; Buss (2004), "Introduction to inverse
kinematics with Jacobian transpose, pseudoinverse and damped least squares methods"; damping by the
error: Sugihara (2011), IEEE Trans. Robotics 27(5), 984-991.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, pi, radians, sin, sqrt
from types import MappingProxyType

import mujoco
import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXIS_NAMES, SIDES
from app.science.avatar.ik.bounded_step import bounded_step
from app.science.avatar.ik.chain import Chain
from app.science.avatar.ik.goals import HEAD, HIPS, LEFT_SHIN, RIGHT_SHIN, Goals, IkError
from app.science.avatar.ik.hips import Tracked, estimated_hips
from app.science.rotations import FloatArray, Quaternion, Vector, q_multiply

_TINY = 1e-12


def rotation_between(current: Quaternion, goal: Quaternion) -> Vector:
    """Return the rotation vector, in the world, that turns `current` into `goal`; at most pi long.

    Both are world_from_part and need only approximately unit length.
    """
    w, x, y, z = current
    dw, dx, dy, dz = q_multiply(goal, (w, -x, -y, -z))
    if dw < 0.0:
        dw, dx, dy, dz = -dw, -dx, -dy, -dz
    sine = sqrt(dx * dx + dy * dy + dz * dz)
    factor = 2.0 * atan2(sine, dw) / sine if sine > _TINY else 2.0
    return (factor * dx, factor * dy, factor * dz)


def turned(current: Quaternion, by: Vector) -> Quaternion:
    """Return `current` rotated by a rotation vector in the world."""
    x, y, z = by
    angle = sqrt(x * x + y * y + z * z)
    half = sin(angle / 2.0) / angle if angle > _TINY else 0.5
    w, x, y, z = q_multiply((cos(angle / 2.0), half * x, half * y, half * z), current)
    scale = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * scale, x * scale, y * scale, z * scale)


KNEE_DEG, ELBOW_DEG = 25.0, 30.0
# Knees and elbows are slightly bent. A small turn of its joint does not shorten a straight limb, so
# a solver that only considers small turns cannot bend it from the T-pose.
REST_POSE_RAD: Mapping[str, float] = MappingProxyType(
    {
        axis: radians(angle)
        for side in SIDES
        for axis, angle in ((f"{side}LowerLegX", KNEE_DEG), (f"{side}LowerArmY", ELBOW_DEG))
    }
)
"""Rest angles by axis; every other axis rests at zero, as in the T-pose."""


CALM, DAMPING = 0.1, 0.5
FAR_M, FAR_RAD = 0.5, pi / 2.0
_ROOT_UNKNOWNS = 6


@dataclass(frozen=True)
class Weights:
    """Weights of the errors: per metre, per radian, and per radian from the rest pose."""

    position: float = 10.0
    rotation: float = 1.0
    rest: float = 0.1


@dataclass(frozen=True, eq=False)
class Solution:
    """The pose of one frame, and how far it is from the goals.

    Attributes:
        angles_rad: (axes,) every hinge of the model in its order; see `axis_names`.
        hips_position_m, hips_rotation: (3,) and (4,) wxyz, world_from_hips.
        position_errors_m: (6,) distance of each part from its goal, in the order of `GOAL_PARTS`;
            NaN where it is not tracked.
        rotation_errors_rad: (6,) likewise the angle between each part and its goal.
    """

    angles_rad: FloatArray
    hips_position_m: FloatArray
    hips_rotation: FloatArray
    position_errors_m: FloatArray
    rotation_errors_rad: FloatArray


class InverseKinematics:
    """Computes the avatar's pose from the tracked parts of one person, frame by frame.

    Args:
        model: an avatar's, as `mjcf.build_mjcf` writes it, with any scene.
        rest_rad: axis -> preferred angle; others rest at zero, and axes that the model lacks are
            ignored.
        weights: the weights of the goals and of the rest pose.
        steps: Gauss-Newton steps per frame.

    Raises:
        IkError: the model is not an avatar's, or `rest_rad` names an unknown axis.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        *,
        rest_rad: Mapping[str, float] = REST_POSE_RAD,
        weights: Weights = Weights(),
        steps: int = 2,
    ) -> None:
        self._chain = chain = Chain(model)
        self._weights, self._steps = weights, steps
        unknown = sorted(set(rest_rad) - set(AXIS_NAMES))
        if unknown:
            raise IkError(
                f"There is no axis {unknown[0]!r} for the rest pose: name it after its part and X,"
                " Y or Z, as in LeftLowerArmY."
            )
        rest = np.array([rest_rad.get(name, 0.0) for name in chain.axis_names])
        self._rest = np.clip(rest, chain.low_rad, chain.high_rad)
        self._low, self._high = chain.low_rad[chain.moving], chain.high_rad[chain.moving]
        self.reset()

    @property
    def axis_names(self) -> tuple[str, ...]:
        """Return the names of the hinges, in the order of a solution's angles."""
        return self._chain.axis_names

    def reset(self) -> None:
        """Forget the last frame: restart from the rest pose with the hips at the origin."""
        self._angles = self._rest.copy()
        self._hips_m, self._hips = np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0))
        self._has_hips = False

    def solve(self, goals: Goals) -> Solution:
        """Return the pose of the next frame."""
        estimate = self._set_hips(goals)
        rows = [row for row in np.flatnonzero(goals.tracked).tolist() if row != HIPS]
        for _ in range(self._steps if rows else 0):
            self._step(goals, rows, estimate)
        self._chain.place(self._hips_m, self._hips, self._angles)
        return self._solution(goals)

    def _set_hips(self, goals: Goals) -> tuple[FloatArray, Quaternion] | None:
        """Set the hips to the waist tracker's pose, or return their estimate if it is not tracked.

        Return None if there is no estimate either.
        """
        if goals.tracked[HIPS]:
            self._hips_m = goals.positions_m[HIPS].copy()
            self._hips = goals.rotations[HIPS] / np.sqrt(np.sum(goals.rotations[HIPS] ** 2))
            self._has_hips = True
            return None
        if not goals.tracked[HEAD]:
            return None
        both_shins = goals.tracked[LEFT_SHIN] and goals.tracked[RIGHT_SHIN]
        shins = (_tracked(goals, LEFT_SHIN), _tracked(goals, RIGHT_SHIN)) if both_shins else None
        place, turn = estimated_hips(self._chain.trunk, _tracked(goals, HEAD), shins)
        estimate = np.array(place)
        if not self._has_hips or self._far_from(estimate, turn):
            self._hips_m, self._hips = estimate, np.array(turn)
        self._has_hips = True
        return estimate, turn

    def _far_from(self, hips_m: FloatArray, hips: Quaternion) -> bool:
        """Return whether the hips are farther from the estimate than its error can be."""
        offset = hips_m - self._hips_m
        turn = rotation_between(_quaternion(self._hips), hips)
        return bool(
            np.sqrt(np.sum(offset**2)) > FAR_M or np.sqrt(np.sum(np.square(turn))) > FAR_RAD
        )

    def _step(
        self, goals: Goals, rows: list[int], estimate: tuple[FloatArray, Quaternion] | None
    ) -> None:
        chain, at = self._chain, self._chain.moving
        chain.place(self._hips_m, self._hips, self._angles)
        chain.prepare_jacobians()
        extra = 0 if estimate is None else _ROOT_UNKNOWNS
        count = len(at) + extra
        angles = self._angles[at]
        jacobian, error, damping = self._system(goals, rows, extra)
        rest = np.zeros(count)
        rest[extra:] = self._rest[at] - angles
        rest[extra:][~chain.moves[rows].any(axis=0)] = 0.0
        low, high = np.full(count, -np.inf), np.full(count, np.inf)
        low[extra:], high[extra:] = self._low - angles, self._high - angles
        if estimate is not None:
            rest[:3] = estimate[0] - self._hips_m
            rest[3:6] = rotation_between(_quaternion(self._hips), estimate[1])
        rest_weight = self._weights.rest**2
        hessian = jacobian.T @ jacobian
        hessian[np.diag_indices(count)] += rest_weight + damping
        step = bounded_step(hessian, jacobian.T @ error + rest_weight * rest, low, high)
        self._angles[at] = np.clip(angles + step[extra:], self._low, self._high)
        if estimate is not None:
            self._hips_m = self._hips_m + step[:3]
            self._hips = np.array(turned(_quaternion(self._hips), _vector(step[3:6])))

    def _system(
        self, goals: Goals, rows: list[int], extra: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return weighted Jacobian (6 goals, unknowns), error (6 goals,), damping (unknowns,)."""
        chain, weights = self._chain, self._weights
        count = extra + len(chain.moving)
        jacobian, error = np.zeros((6 * len(rows), count)), np.empty(6 * len(rows))
        damping = np.full(count, CALM)
        for index, row in enumerate(rows):
            block = slice(6 * index, 6 * index + 6)
            position = chain.position_m(row)
            error[block][:3] = goals.positions_m[row] - position
            error[block][3:] = rotation_between(
                _quaternion(chain.rotation(row)), _quaternion(goals.rotations[row])
            )
            jacobian[block, extra:] = chain.jacobian(row)
            if extra:
                jacobian[block, :extra] = _rigid(position - self._hips_m)
            for part, weight in ((slice(0, 3), weights.position), (slice(3, 6), weights.rotation)):
                jacobian[block][part] *= weight
                error[block][part] *= weight
            squared = DAMPING * float(np.sum(error[block] ** 2))
            damping[:extra] += squared
            damping[extra:][chain.moves[row]] += squared
        return jacobian, error, damping

    def _solution(self, goals: Goals) -> Solution:
        positions, rotations = np.full(len(goals.tracked), np.nan), np.full(6, np.nan)
        for row in np.flatnonzero(goals.tracked).tolist():
            offset = goals.positions_m[row] - self._chain.position_m(row)
            turn = rotation_between(
                _quaternion(self._chain.rotation(row)), _quaternion(goals.rotations[row])
            )
            positions[row] = np.sqrt(np.sum(offset**2))
            rotations[row] = np.sqrt(np.sum(np.square(turn)))
        return Solution(
            self._angles.copy(), self._hips_m.copy(), self._hips.copy(), positions, rotations
        )


def _rigid(arm: FloatArray) -> npt.NDArray[np.float64]:
    """Return the Jacobian (6, 6) of a point at `arm` from the hips for movements of the hips."""
    x, y, z = arm.tolist()
    matrix = np.eye(6)
    matrix[:3, 3:] = ((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))
    return matrix


def _tracked(goals: Goals, row: int) -> Tracked:
    return Tracked(_vector(goals.positions_m[row]), _quaternion(goals.rotations[row]))


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def _quaternion(values: FloatArray) -> Quaternion:
    w, x, y, z = values.tolist()
    return (w, x, y, z)
