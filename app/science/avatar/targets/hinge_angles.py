"""Compute the hinge angles that make given rotations, in closed form and in compiled code.

A part's rotation is a product of turns about its own axes, R = R(e1, a) R(e2, b) R(e3, c). In the
frame of its axes, with B = [e1 e2 e3], it is a product about x, y and z. Where e1, e2, e3 are
left-handed the turns go in the opposite direction, so there the angles change sign:

    (w, v) -> (w, d B^T v),   (a, b, c) -> d (a, b, c),   d = det B.

Three axes can make every rotation, with two solutions: (a, b, c) and (a + pi, pi - b, c + pi). With
M = R(x, -a) R the second and third angle are read off M, whichever a was chosen:

    a = atan2(-R23, R33),   b = atan2(R13, M33),   c = atan2(M21, M22).

At b = +-90 deg only a +- c is determined (gimbal lock): half of the change since the last frame
goes to either angle, which is the least change.

Two axes cannot make every rotation. The product of the two half-angle quaternions has the
components (ca cb, sa cb, ca sb, sa sb); its dot product with q is greatest, and so the remaining
angle least, at

    (a + b) / 2 = atan2(x + y, w - z),   (a - b) / 2 = atan2(x - y, w + z).

One axis takes the twist about it, a = 2 atan2(x, w). Importing this module loads the compiler.
"""

from math import acos, atan2, cos, hypot, isfinite, nan, pi, sin

import numpy as np
import numpy.typing as npt

from app.science.compiled import compiled, compiled_inside
from app.science.retargeting import IntArray
from app.science.rotations import FloatArray, Quaternion, Vector, q_multiply

BoolArray = npt.NDArray[np.bool_]
_TURN = 2.0 * pi
_LOCKED_COSINE = 1e-11
SWITCH_MARGIN_RAD = pi / 4
"""How much further within the limits the other solution must lie to be chosen."""
_FARTHEST_RAD = 1.25 * pi
_STRAIGHT_LIMB = 0.05


_product = compiled_inside(q_multiply)


@compiled
def _row(rows: FloatArray, row: int) -> Quaternion:
    return rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3]


@compiled
def _set_row(rows: FloatArray, row: int, q: Quaternion) -> None:
    rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3] = q


@compiled
def _in_frame(q: Quaternion, frame: FloatArray, hand: float) -> Quaternion:
    """Return the rotation in the frame of the columns of `frame`; `hand` is its handedness."""
    w, x, y, z = q
    return (
        w,
        hand * (frame[0, 0] * x + frame[1, 0] * y + frame[2, 0] * z),
        hand * (frame[0, 1] * x + frame[1, 1] * y + frame[2, 1] * z),
        hand * (frame[0, 2] * x + frame[1, 2] * y + frame[2, 2] * z),
    )


@compiled
def _three(q: Quaternion, previous_angles: Vector) -> Vector:
    """Return one of the two solutions for a part with three axes; see the module docstring."""
    w, x, y, z = q
    r13, r23, r33 = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    r21, r22 = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z)
    r31, r32 = 2 * (x * z - w * y), 2 * (y * z + w * x)
    if hypot(r23, r33) < _LOCKED_COSINE:
        side = 1.0 if r13 > 0.0 else -1.0
        change = atan2(r21, r22) - (previous_angles[2] + side * previous_angles[0])
        a = previous_angles[0] + side * (change - _TURN * round(change / _TURN)) / 2
    else:
        a = atan2(-r23, r33)
    cosine, sine = cos(a), sin(a)
    b = atan2(r13, cosine * r33 - sine * r23)
    return a, b, atan2(cosine * r21 + sine * r31, cosine * r22 + sine * r32)


@compiled
def _two(q: Quaternion) -> tuple[float, float, float]:
    """Return both angles of a part with two axes, and the angle by which they miss its rotation."""
    w, x, y, z = q
    total, difference = atan2(x + y, w - z), atan2(x - y, w + z)
    near = (hypot(x + y, w - z) + hypot(x - y, w + z)) / 2
    return total + difference, total - difference, 2.0 * acos(min(near, 1.0))


@compiled
def _unwrapped(angle: float, previous: float, middle: float) -> float:
    """Add whole turns so that the angle is near the previous one.

    An angle that would be more than 225 degrees from `middle`, the middle of its range, is brought
    near the middle instead, so that turns do not accumulate.
    """
    near = angle + _TURN * round((previous - angle) / _TURN)
    if abs(near - middle) > _FARTHEST_RAD:
        near += _TURN * round((middle - near) / _TURN)
    return near


@compiled
def _choose(
    solution: Vector, hand: float, at: int, low: FloatArray, high: FloatArray,
    previous: FloatArray, margin: float, unclamped: FloatArray,
) -> None:  # fmt: skip
    """Write the solution nearer to the previous angles, or the one that fits the limits better.

    The second rule applies where the angles beyond the limits differ by more than the margin.
    """
    a, b, c = solution
    other = a + pi, pi - b, c + pi
    beyond, far = 0.0, 0.0
    for k in range(3):
        middle = (low[at + k] + high[at + k]) / 2
        p = _unwrapped(hand * solution[k], previous[at + k], middle)
        q = _unwrapped(hand * other[k], previous[at + k], middle)
        unclamped[at + k] = q
        over_p = max(low[at + k] - p, p - high[at + k], 0.0)
        beyond += over_p - max(low[at + k] - q, q - high[at + k], 0.0)
        far += abs(p - previous[at + k]) - abs(q - previous[at + k])
    if (beyond < 0.0) if abs(beyond) > margin else (far <= 0.0):
        for k in range(3):
            middle = (low[at + k] + high[at + k]) / 2
            unclamped[at + k] = _unwrapped(hand * solution[k], previous[at + k], middle)


@compiled
def multiply_undriven(rotations: FloatArray, into: IntArray, rows: FloatArray) -> None:
    """Multiply each driven part's rotation by those of the undriven parts above it.

    Each row of `into` lists the part itself and the parts above it, upwards, padded with -1.
    """
    for part in range(into.shape[0]):
        q = _row(rotations, into[part, 0])
        for k in range(1, into.shape[1]):
            if into[part, k] >= 0:
                q = _product(_row(rotations, into[part, k]), q)
        _set_row(rows, part, q)


@compiled
def turn_bend_planes(hinges: IntArray, frames: FloatArray, rows: FloatArray) -> None:
    """Turn the bone above each elbow and knee about its own axis until the hinge fits the bend.

    In the frame (bend, other, bone), the hinge's rotation is R(z, t) R(x, bend) R(z, p): t goes to
    the bone above. A nearly straight limb has no bend plane; there t fades to zero.
    """
    for k in range(hinges.shape[0]):
        above, below = hinges[k, 0], hinges[k, 1]
        w, x, y, z = _in_frame(_row(rows, below), frames[k], 1.0)
        across = x * w - y * z, y * w + x * z
        length = max(hypot(w, z), 1e-12)
        half = atan2(across[1] / length, across[0] / length + _STRAIGHT_LIMB) / 2
        s, c = sin(half), cos(half)
        bone = frames[k, 0, 2], frames[k, 1, 2], frames[k, 2, 2]
        turn = c, s * bone[0], s * bone[1], s * bone[2]
        back = c, -s * bone[0], -s * bone[1], -s * bone[2]
        _set_row(rows, above, _product(_row(rows, above), turn))
        _set_row(rows, below, _product(back, _row(rows, below)))


@compiled
def fit(
    rows: FloatArray, columns: IntArray, counts: IntArray, frames: FloatArray, hands: FloatArray,
    low: FloatArray, high: FloatArray, previous: FloatArray, margin: float,
    unclamped: FloatArray, residual: FloatArray,
) -> None:  # fmt: skip
    """Write each part's angles from its first column on, and their residual from its rotation.

    `margin` is how much further within the limits the farther solution must lie to be chosen. A
    rotation that is not finite gives angles that are not finite.
    """
    for part in range(counts.shape[0]):
        at, hand = columns[part], hands[part]
        q = _in_frame(_row(rows, part), frames[part], hand)
        middle = (low[at] + high[at]) / 2
        residual[part] = 0.0
        if not isfinite(q[0] + q[1] + q[2] + q[3]):
            unclamped[at : at + counts[part]] = nan
            residual[part] = nan
        elif counts[part] == 3:
            previous_angles = hand * previous[at], hand * previous[at + 1], hand * previous[at + 2]
            _choose(_three(q, previous_angles), hand, at, low, high, previous, margin, unclamped)
        elif counts[part] == 2:
            a, b, residual[part] = _two(q)
            unclamped[at] = _unwrapped(a, previous[at], middle)
            unclamped[at + 1] = _unwrapped(b, previous[at + 1], (low[at + 1] + high[at + 1]) / 2)
        else:
            unclamped[at] = _unwrapped(2.0 * atan2(q[1], q[0]), previous[at], middle)
            residual[part] = 2.0 * acos(min(hypot(q[0], q[1]), 1.0))


@compiled
def move_wrist_excess(
    pairs: IntArray, low: FloatArray, high: FloatArray, unclamped: FloatArray
) -> None:
    """Move the wrist's turn beyond its limits to the forearm, which has the same axis."""
    for k in range(pairs.shape[0]):
        wrist, forearm = pairs[k, 0], pairs[k, 1]
        clamped = min(max(unclamped[wrist], low[wrist]), high[wrist])
        unclamped[forearm] += unclamped[wrist] - clamped
        unclamped[wrist] = clamped


@compiled
def follow_frames(
    local: FloatArray, restarts: BoolArray, folded: IntArray, bends: IntArray,
    bend_frames: FloatArray, columns: IntArray, counts: IntArray, frames: FloatArray,
    hands: FloatArray, parts: IntArray, wrists: IntArray, low: FloatArray, high: FloatArray,
    rest: FloatArray, followed: FloatArray, angles: FloatArray, unclamped: FloatArray,
    residual: FloatArray,
) -> None:  # fmt: skip
    """Write clamped angles, unclamped angles and residuals of N frames, one after another.

    A single frame takes the same path, so its result is the same. `followed` (91,) carries the last
    finite unclamped angles from frame to frame. The wrist's excess is moved to the forearm after
    they are stored, so the wrist is followed with its full angle.
    """
    rows = np.empty((counts.shape[0], 4))
    residuals = np.empty(counts.shape[0])
    for frame in range(local.shape[0]):
        margin = SWITCH_MARGIN_RAD
        if restarts[frame]:
            followed[:] = rest
            margin = 0.0
        unclamped_row = unclamped[frame]
        unclamped_row[:] = rest
        multiply_undriven(local[frame], folded, rows)
        turn_bend_planes(bends, bend_frames, rows)
        fit(
            rows,
            columns,
            counts,
            frames,
            hands,
            low,
            high,
            followed,
            margin,
            unclamped_row,
            residuals,
        )
        for column in range(unclamped_row.shape[0]):
            if isfinite(unclamped_row[column]):
                followed[column] = unclamped_row[column]
        move_wrist_excess(wrists, low, high, unclamped_row)
        for column in range(unclamped_row.shape[0]):
            angles[frame, column] = min(max(unclamped_row[column], low[column]), high[column])
        residual[frame] = 0.0
        for part in range(parts.shape[0]):
            residual[frame, parts[part]] = residuals[part]
