"""Refine all unknowns of an alignment together, and state how certain they are.

The unknowns are changed by small rotations a (of Y, in the headset's world) and b (of X, in the
head's axes), and by small differences of the others. With P = Y tracker X the predicted head, u the
vector from the middle of all positions to the predicted head, w and v the head's angular velocity
in its own axes and its velocity in the world, the errors change by

    rotation error, in the head's axes:  -(P^T a + b + w d_delay)
    position error, in the world:        -(a x u + d_position + d_drift (t - t_middle)
                                           + Y R_tracker d_mount + v d_delay).

The velocities are those by the headset, which is steadier than a tracker, and from the samples
beside each one: were their noise part of the error, too, the delay would be biased. The world's
position is that of the middle of all positions, not of a far origin, so that rotation
and position hardly depend on each other.
"""

from dataclasses import dataclass

import numpy as np

from app.science.alignment.delay import repetition
from app.science.alignment.looking import looking_around
from app.science.alignment.poses import AlignmentError, BoolArray, PoseStream, robust_spread
from app.science.alignment.results import REACH_M, Alignment, Mount, Quality
from app.science.rotations import (
    FloatArray,
    conjugate,
    from_rotation_vector,
    matrices,
    multiply,
    normalise,
    rotate,
    to_rotation_vector,
)

_TURN, _PLACE, _DRIFT, _MOUNT_TURN, _MOUNT_PLACE, _DELAY = (
    slice(0, 3),
    slice(3, 6),
    slice(6, 9),
    slice(9, 12),
    slice(12, 15),
    slice(15, 16),
)
_COUNT = 16
_CUT = 50.0  # squared error in spreads, 6 degrees of freedom: 1 good sample in 10^8 is beyond
_STEPS = 12
_SMALL = 0.02  # of its standard error
_LEAST_SPREAD = 1e-9  # metres and radians: keeps errors of exact data from dividing by zero
_SPEED_STEP_S = 0.03
_LEAST_SAMPLES = 30
_BLOCK = 512
_FEW = 300
_DRIFT_FROM_S = 10.0
_DRIFT_SURE = 16.27  # 99.9 % quantile of chi squared with 3 degrees of freedom


@dataclass(frozen=True, eq=False)
class Pairs:
    """The head by the headset at the times at which both are known, and the tracker's stream.

    `turning_rad_s` (N, 3) is the head's angular velocity in its own axes, `moving_m_s` (N, 3) its
    velocity in the world.
    """

    times_s: FloatArray
    head_m: FloatArray
    head_q: FloatArray
    turning_rad_s: FloatArray
    moving_m_s: FloatArray
    weights: FloatArray
    tracker: PoseStream

    @classmethod
    def of(cls, headset: PoseStream, tracker: PoseStream, delay_s: float) -> "Pairs":
        """Pair both streams at the headset's times.

        Raises:
            AlignmentError: `short`: they are known together at too few times.
        """
        tracker = tracker.without_spikes()
        _, _, weights = tracker.at(headset.times_s + delay_s)
        weights = weights * headset.weights
        before_m, before_q, _ = headset.at(headset.times_s - _SPEED_STEP_S)
        after_m, after_q, _ = headset.at(headset.times_s + _SPEED_STEP_S)
        used = weights > 0.0
        count = int(np.count_nonzero(used))
        if count < _LEAST_SAMPLES:
            raise AlignmentError(
                "short",
                f"Head and tracker are known together at {count} samples:"
                f" at least {_LEAST_SAMPLES} are needed.",
            )
        turn = to_rotation_vector(multiply(conjugate(before_q), after_q))
        return cls(
            times_s=headset.times_s[used],
            head_m=headset.positions_m[used],
            head_q=headset.rotations[used],
            turning_rad_s=turn[used] / (2.0 * _SPEED_STEP_S),
            moving_m_s=(after_m - before_m)[used] / (2.0 * _SPEED_STEP_S),
            weights=weights[used],
            tracker=tracker,
        )

    def thinned(self) -> "Pairs":
        """Return some hundred of the pairs, evenly chosen; all of them if they are not more."""
        every = slice(None, None, max(1, len(self.times_s) // _FEW))
        return Pairs(
            times_s=self.times_s[every],
            head_m=self.head_m[every],
            head_q=self.head_q[every],
            turning_rad_s=self.turning_rad_s[every],
            moving_m_s=self.moving_m_s[every],
            weights=self.weights[every],
            tracker=self.tracker,
        )


@dataclass(frozen=True, eq=False)
class Unknowns:
    """What is fitted; see `Alignment` and `Mount` for the meaning."""

    world_q: FloatArray
    world_m: FloatArray
    drift_m_s: FloatArray
    mount_q: FloatArray
    mount_m: FloatArray
    delay_s: float

    @classmethod
    def of(cls, mount: Mount) -> "Unknowns":
        """Return a known tracker on the head in a world that is still to be found."""
        return cls(
            np.array((1.0, 0.0, 0.0, 0.0)),
            np.zeros(3),
            np.zeros(3),
            mount.rotation,
            mount.position_m,
            mount.delay_s,
        )


@dataclass(frozen=True, eq=False)
class _Solved:
    """The unknowns, their covariance (16, 16), and the errors of each sample."""

    unknowns: Unknowns
    covariance: FloatArray
    condition: float
    errors_rad: FloatArray
    errors_m: FloatArray
    kept: BoolArray
    middle_s: float


def refine(
    pairs: Pairs, start: Unknowns, *, free_mount: bool, mount: Mount | None = None
) -> Alignment:
    """Return the best alignment near a first guess, with drift if the samples prove one.

    Args:
        pairs: the samples.
        start: the first guess.
        free_mount: fit the tracker on the head and the delay, too; else they stay.
        mount: the known tracker on the head, where it stays.
    """
    free = np.ones(_COUNT, dtype=np.bool_)
    if not free_mount:
        free[_MOUNT_TURN] = free[_MOUNT_PLACE] = free[_DELAY] = False
    free[_DRIFT] = False
    near = _solve(pairs.thinned(), start, free).unknowns  # a fraction of the work of all samples
    if pairs.times_s[-1] - pairs.times_s[0] >= _DRIFT_FROM_S:
        free[_DRIFT] = True
        solved = _solve(pairs, near, free)
        drift = solved.unknowns.drift_m_s
        if drift @ np.linalg.solve(solved.covariance[_DRIFT, _DRIFT], drift) > _DRIFT_SURE:
            return _alignment(pairs, solved, None if free_mount else mount)
        free[_DRIFT] = False
    solved = _solve(pairs, near, free)
    return _alignment(pairs, solved, None if free_mount else mount)


def _solve(pairs: Pairs, start: Unknowns, free: BoolArray) -> _Solved:
    middle_s = 0.5 * float(pairs.times_s[0] + pairs.times_s[-1])
    unknowns = start
    for number in range(_STEPS):
        table, errors, centre = _equations(pairs, unknowns, middle_s)
        weights, kept = _weights(errors, pairs.weights)
        normal, right = _normal(table, errors, weights, free)
        scale = 1.0 / np.sqrt(np.diag(normal))
        scaled = normal * scale * scale[:, np.newaxis]
        step = scale * np.linalg.lstsq(scaled, scale * right, rcond=1e-12)[0]
        if number == _STEPS - 1 or float(np.abs(step / scale).max()) < _SMALL:
            break
        unknowns = _moved(unknowns, step, free, centre)
    whitened = errors * np.sqrt(weights)
    variance = float(np.sum(whitened**2)) / max(6 * int(kept.sum()) - int(free.sum()), 1)
    covariance = np.zeros((_COUNT, _COUNT))
    covariance[np.ix_(free, free)] = (
        np.linalg.pinv(scaled, rcond=1e-12, hermitian=True)
        * scale
        * scale[:, np.newaxis]
        * variance
        * repetition(whitened)
    )
    return _Solved(
        unknowns=unknowns,
        covariance=covariance,
        condition=float(np.linalg.cond(scaled)),
        errors_rad=np.linalg.norm(errors[:, :3], axis=1),
        errors_m=np.linalg.norm(errors[:, 3:], axis=1),
        kept=kept,
        middle_s=middle_s,
    )


def _equations(
    pairs: Pairs, unknowns: Unknowns, middle_s: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the table (N, 6, 16), the errors (N, 6), and the middle of the predicted heads (3,).

    Errors are rotation in the head's axes, then position in the world.
    """
    at_s = pairs.times_s + unknowns.delay_s
    tracker_m, tracker_q, _ = pairs.tracker.at(at_s)
    world_q = unknowns.world_q
    turned_q = multiply(world_q, tracker_q)
    predicted_q = multiply(turned_q, unknowns.mount_q)
    elapsed_s = (pairs.times_s - middle_s)[:, np.newaxis]
    place_m = rotate(world_q, tracker_m + rotate(tracker_q, unknowns.mount_m))
    predicted_m = place_m + unknowns.world_m + elapsed_s * unknowns.drift_m_s
    centre = place_m.mean(axis=0)

    table = np.zeros((len(at_s), 6, _COUNT))
    to_head = np.swapaxes(matrices(predicted_q), -1, -2)
    table[:, :3, _TURN] = to_head
    table[:, :3, _MOUNT_TURN] = np.eye(3)
    table[:, :3, 15] = pairs.turning_rad_s
    table[:, 3:, _TURN] = -_cross(place_m - centre)
    table[:, 3:, _PLACE] = np.eye(3)
    table[:, 3:, _DRIFT] = elapsed_s[..., np.newaxis] * np.eye(3)
    table[:, 3:, _MOUNT_PLACE] = matrices(turned_q)
    table[:, 3:, 15] = pairs.moving_m_s
    errors = np.concatenate(
        (
            to_rotation_vector(multiply(conjugate(predicted_q), pairs.head_q)),
            pairs.head_m - predicted_m,
        ),
        axis=1,
    )
    return table, errors, centre


def _cross(vectors: FloatArray) -> FloatArray:
    """Return the matrices (N, 3, 3) that multiply by `vectors` (N, 3) from the left, u x."""
    zero = np.zeros(len(vectors))
    x, y, z = vectors.T
    return np.stack((zero, -z, y, z, zero, -x, -y, x, zero), axis=-1).reshape(-1, 3, 3)


def _weights(errors: FloatArray, given: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Return weights (N, 6) of the errors, and which samples are not outliers (N,)."""
    rad, metres = (np.linalg.norm(part, axis=1) for part in (errors[:, :3], errors[:, 3:]))
    spread_rad, spread_m = robust_spread(rad, _LEAST_SPREAD), robust_spread(metres, _LEAST_SPREAD)
    squared = (rad / spread_rad) ** 2 + (metres / spread_m) ** 2
    kept = squared < _CUT
    weight = given * np.where(kept, (1.0 - squared / _CUT) ** 2, 0.0)
    each = np.repeat((1.0 / spread_rad**2, 1.0 / spread_m**2), 3)
    return weight[:, np.newaxis] * each, kept


def _normal(
    table: FloatArray, errors: FloatArray, weights: FloatArray, free: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return the normal matrix and the right side of the weighted equations.

    They are summed up in blocks, which are too small for the linear algebra library to divide among
    threads: those would cost more than the sums.
    """
    count = int(free.sum())
    flat = (table if count == _COUNT else table[..., free]).reshape(-1, count)
    normal, right = np.zeros((count, count)), np.zeros(count)
    flat_weights, flat_errors = weights.ravel(), errors.ravel()
    for start in range(0, len(flat), _BLOCK):
        block = slice(start, start + _BLOCK)
        weighted = (flat[block] * flat_weights[block, np.newaxis]).T
        normal += weighted @ flat[block]
        right += weighted @ flat_errors[block]
    return normal, right


def _moved(unknowns: Unknowns, found: FloatArray, free: BoolArray, centre: FloatArray) -> Unknowns:
    """Return unknowns of which the free ones changed by `found`; worlds turn about `centre`."""
    step = np.zeros(_COUNT)
    step[free] = found
    turn = from_rotation_vector(step[_TURN])
    return Unknowns(
        world_q=normalise(multiply(turn, unknowns.world_q)),
        world_m=unknowns.world_m + step[_PLACE] + centre - rotate(turn, centre),
        drift_m_s=unknowns.drift_m_s + step[_DRIFT],
        mount_q=normalise(multiply(unknowns.mount_q, from_rotation_vector(step[_MOUNT_TURN]))),
        mount_m=unknowns.mount_m + step[_MOUNT_PLACE],
        delay_s=unknowns.delay_s + float(step[_DELAY][0]),
    )


def _alignment(pairs: Pairs, solved: _Solved, mount: Mount | None) -> Alignment:
    covariance, unknowns = solved.covariance, solved.unknowns
    start_s, end_s = float(pairs.times_s[0]), float(pairs.times_s[-1])
    if mount is None:
        mount = Mount(
            rotation=unknowns.mount_q,
            position_m=unknowns.mount_m,
            delay_s=unknowns.delay_s,
            delay_uncertainty_s=float(np.sqrt(covariance[15, 15])),
            uncertainty_rad=_largest(covariance[_MOUNT_TURN, _MOUNT_TURN]),
        )
        turn = _largest(covariance[_TURN, _TURN])
    else:  # an error of the mount turns the world
        turn = float(np.hypot(_largest(covariance[_TURN, _TURN]), mount.uncertainty_rad))
    at_end = np.concatenate((np.eye(3), (end_s - solved.middle_s) * np.eye(3)), axis=1)
    place = _largest(at_end @ covariance[3:9, 3:9] @ at_end.T)
    rad, metres = solved.errors_rad, solved.errors_m
    return Alignment(
        rotation=unknowns.world_q,
        position_m=unknowns.world_m,
        drift_m_s=unknowns.drift_m_s,
        reference_s=solved.middle_s,
        start_s=start_s,
        end_s=end_s,
        mount=mount,
        quality=Quality(
            samples=len(rad),
            outliers=float(np.mean(~solved.kept)),
            residual_m=float(np.median(metres)),
            residual_p95_m=float(np.percentile(metres, 95.0)),
            residual_rad=float(np.median(rad)),
            residual_p95_rad=float(np.percentile(rad, 95.0)),
            uncertainty_m=float(np.hypot(place, REACH_M * turn)),
            condition=solved.condition,
            looking=looking_around(pairs.head_q),
        ),
    )


def _largest(covariance: FloatArray) -> float:
    """Return the standard error along the axis for which it is largest."""
    return float(np.sqrt(max(float(np.linalg.eigvalsh(covariance)[-1]), 0.0)))
