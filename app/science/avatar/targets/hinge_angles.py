"""From rotations to the angles of the hinges that make them: closed forms, compiled.

A part's rotation is a product of turns about its own axes, R = R(e1, a) R(e2, b) R(e3, c). Seen
along its axes, with B = [e1 e2 e3], it is a product about x, y and z. Where e1, e2, e3 are
left-handed the turns go the other way round, so there the angles change sign:

    (w, v) -> (w, d B^T v),   (a, b, c) -> d (a, b, c),   d = det B.

Three axes make every rotation, in two ways: (a, b, c) and (a + pi, pi - b, c + pi). With
M = R(x, -a) R the second and third angle are read off M, whichever way a was chosen:

    a = atan2(-R23, R33),   b = atan2(R13, M33),   c = atan2(M21, M22).

At b = +-90 deg only a +- c is determined (gimbal lock): half of the change since the last frame
goes to either angle, which is the least change.

Two axes cannot make every rotation. The product of the two half-angle quaternions has the parts
(ca cb, sa cb, ca sb, sa sb); its product with q is greatest, so the angle left over least, at

    (a + b) / 2 = atan2(x + y, w - z),   (a - b) / 2 = atan2(x - y, w + z).

One axis takes the twist about it, a = 2 atan2(x, w). Importing this module loads the compiler.
"""

from math import acos, atan2, cos, hypot, isfinite, nan, pi, sin

import numpy as np
import numpy.typing as npt

from app.science.compiled import compiled_fused
from app.science.retargeting import IntArray
from app.science.rotations import FloatArray, Quaternion, Vector, q_multiply

BoolArray = npt.NDArray[np.bool_]
_TURN = 2.0 * pi
_LOCKED_COSINE = 1e-11
GIVE_UP_RAD = pi / 4
"""How much further within the limits the other way must lie to be taken."""
_FARTHEST_RAD = 1.25 * pi
_STRAIGHT = 0.05


_product = compiled_fused(q_multiply)


@compiled_fused
def _read(rows: FloatArray, row: int) -> Quaternion:
    return rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3]


@compiled_fused
def _write(rows: FloatArray, row: int, q: Quaternion) -> None:
    rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3] = q


@compiled_fused
def _seen(q: Quaternion, frame: FloatArray, hand: float) -> Quaternion:
    """The rotation along the columns of a frame."""
    w, x, y, z = q
    return (
        w,
        hand * (frame[0, 0] * x + frame[1, 0] * y + frame[2, 0] * z),
        hand * (frame[0, 1] * x + frame[1, 1] * y + frame[2, 1] * z),
        hand * (frame[0, 2] * x + frame[1, 2] * y + frame[2, 2] * z),
    )


@compiled_fused
def _three(q: Quaternion, before: Vector) -> Vector:
    """One of the two ways; see the module."""
    w, x, y, z = q
    r13, r23, r33 = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    r21, r22 = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z)
    r31, r32 = 2 * (x * z - w * y), 2 * (y * z + w * x)
    if hypot(r23, r33) < _LOCKED_COSINE:
        side = 1.0 if r13 > 0.0 else -1.0
        change = atan2(r21, r22) - (before[2] + side * before[0])
        a = before[0] + side * (change - _TURN * round(change / _TURN)) / 2
    else:
        a = atan2(-r23, r33)
    cosine, sine = cos(a), sin(a)
    b = atan2(r13, cosine * r33 - sine * r23)
    return a, b, atan2(cosine * r21 + sine * r31, cosine * r22 + sine * r32)


@compiled_fused
def _two(q: Quaternion) -> tuple[float, float, float]:
    """Both angles, and how much of the rotation is left."""
    w, x, y, z = q
    total, difference = atan2(x + y, w - z), atan2(x - y, w + z)
    near = (hypot(x + y, w - z) + hypot(x - y, w + z)) / 2
    return total + difference, total - difference, 2.0 * acos(min(near, 1.0))


@compiled_fused
def _settled(angle: float, previous: float, middle: float) -> float:
    """Near to the last frame, unless that leads round and round."""
    near = angle + _TURN * round((previous - angle) / _TURN)
    if abs(near - middle) > _FARTHEST_RAD:
        near += _TURN * round((middle - near) / _TURN)
    return near


@compiled_fused
def _choose(
    one: Vector, hand: float, at: int, low: FloatArray, high: FloatArray,
    previous: FloatArray, margin: float, wanted: FloatArray,
) -> None:  # fmt: skip
    """Write the nearer way, or the one that is further within the limits by the margin."""
    a, b, c = one
    other = a + pi, pi - b, c + pi
    beyond, far = 0.0, 0.0
    for k in range(3):
        middle = (low[at + k] + high[at + k]) / 2
        p = _settled(hand * one[k], previous[at + k], middle)
        q = _settled(hand * other[k], previous[at + k], middle)
        wanted[at + k] = q
        over_p = max(low[at + k] - p, p - high[at + k], 0.0)
        beyond += over_p - max(low[at + k] - q, q - high[at + k], 0.0)
        far += abs(p - previous[at + k]) - abs(q - previous[at + k])
    if (beyond < 0.0) if abs(beyond) > margin else (far <= 0.0):
        for k in range(3):
            middle = (low[at + k] + high[at + k]) / 2
            wanted[at + k] = _settled(hand * one[k], previous[at + k], middle)


@compiled_fused
def fold_in(rotations: FloatArray, into: IntArray, rows: FloatArray) -> None:
    """Give the rotation of what does not turn to the part below: rows[i] = ... rotations[into]."""
    for part in range(into.shape[0]):
        q = _read(rotations, into[part, 0])
        for k in range(1, into.shape[1]):
            if into[part, k] >= 0:
                q = _product(_read(rotations, into[part, k]), q)
        _write(rows, part, q)


@compiled_fused
def turn_bend_planes(hinges: IntArray, frames: FloatArray, rows: FloatArray) -> None:
    """Turn the bone above each elbow and knee about itself until the hinge lies across the bend.

    Seen along (bend, other, bone), the hinge's rotation is R(z, t) R(x, bend) R(z, p): t goes to
    the bone above. A nearly straight limb has no bend plane; there t fades to zero.
    """
    for k in range(hinges.shape[0]):
        above, below = hinges[k, 0], hinges[k, 1]
        w, x, y, z = _seen(_read(rows, below), frames[k], 1.0)
        across = x * w - y * z, y * w + x * z
        length = max(hypot(w, z), 1e-12)
        half = atan2(across[1] / length, across[0] / length + _STRAIGHT) / 2
        s, c = sin(half), cos(half)
        bone = frames[k, 0, 2], frames[k, 1, 2], frames[k, 2, 2]
        turn = c, s * bone[0], s * bone[1], s * bone[2]
        back = c, -s * bone[0], -s * bone[1], -s * bone[2]
        _write(rows, above, _product(_read(rows, above), turn))
        _write(rows, below, _product(back, _read(rows, below)))


@compiled_fused
def fit(
    rows: FloatArray, columns: IntArray, counts: IntArray, frames: FloatArray, hands: FloatArray,
    low: FloatArray, high: FloatArray, previous: FloatArray, margin: float,
    wanted: FloatArray, residual: FloatArray,
) -> None:  # fmt: skip
    """Write each part's angles from its first column on, and what they miss of its rotation.

    `margin` is how much further within the limits the farther way must lie to be taken. A rotation
    that is not finite gives angles that are not.
    """
    for part in range(counts.shape[0]):
        at, hand = columns[part], hands[part]
        q = _seen(_read(rows, part), frames[part], hand)
        middle = (low[at] + high[at]) / 2
        residual[part] = 0.0
        if not isfinite(q[0] + q[1] + q[2] + q[3]):
            wanted[at : at + counts[part]] = nan
            residual[part] = nan
        elif counts[part] == 3:
            before = hand * previous[at], hand * previous[at + 1], hand * previous[at + 2]
            _choose(_three(q, before), hand, at, low, high, previous, margin, wanted)
        elif counts[part] == 2:
            a, b, residual[part] = _two(q)
            wanted[at] = _settled(a, previous[at], middle)
            wanted[at + 1] = _settled(b, previous[at + 1], (low[at + 1] + high[at + 1]) / 2)
        else:
            wanted[at] = _settled(2.0 * atan2(q[1], q[0]), previous[at], middle)
            residual[part] = 2.0 * acos(min(hypot(q[0], q[1]), 1.0))


@compiled_fused
def pass_on(pairs: IntArray, low: FloatArray, high: FloatArray, wanted: FloatArray) -> None:
    """What the wrist cannot turn about the forearm's axis, the forearm does: the axes are one."""
    for k in range(pairs.shape[0]):
        wrist, forearm = pairs[k, 0], pairs[k, 1]
        left = min(max(wanted[wrist], low[wrist]), high[wrist])
        wanted[forearm] += wanted[wrist] - left
        wanted[wrist] = left


@compiled_fused
def follow_frames(
    local: FloatArray, anew: BoolArray, folded: IntArray, bends: IntArray, bend_frames: FloatArray,
    columns: IntArray, counts: IntArray, frames: FloatArray, hands: FloatArray, parts: IntArray,
    wrists: IntArray, low: FloatArray, high: FloatArray, rest: FloatArray, followed: FloatArray,
    angles: FloatArray, wanted: FloatArray, residual: FloatArray,
) -> None:  # fmt: skip
    """Write clamped and unclamped angles and what is missed of N frames, one after the other.

    One frame alone goes the same way, so it comes out the same. `followed` (91,) is kept from frame
    to frame; it is what was wanted last, where that was a number. The wrist's share moves after it
    is kept: it is followed as it was.
    """
    rows = np.empty((counts.shape[0], 4))
    missed = np.empty(counts.shape[0])
    for frame in range(local.shape[0]):
        margin = GIVE_UP_RAD
        if anew[frame]:
            followed[:] = rest
            margin = 0.0
        asked = wanted[frame]
        asked[:] = rest
        fold_in(local[frame], folded, rows)
        turn_bend_planes(bends, bend_frames, rows)
        fit(rows, columns, counts, frames, hands, low, high, followed, margin, asked, missed)
        for column in range(asked.shape[0]):
            if isfinite(asked[column]):
                followed[column] = asked[column]
        pass_on(wrists, low, high, asked)
        for column in range(asked.shape[0]):
            angles[frame, column] = min(max(asked[column], low[column]), high[column])
        residual[frame] = 0.0
        for part in range(parts.shape[0]):
            residual[frame, parts[part]] = missed[part]
