"""Place trunk, legs and arms of a pose, compiled: what `posture` computes for each frame.

A pose is an array (22, 4) of local rotations wxyz, which these functions change in place. They
round as plain Python does, so that a cohort is the same to the last bit. Importing this module
loads the compiler.
"""

from math import exp, sqrt

import numpy as np
import numpy.typing as npt

from app.science import rotations
from app.science.compiled import compiled, compiled_inside
from app.science.rotations import IDENTITY, FloatArray, Quaternion, Vector
from app.science.simulation.two_bone import (
    arm_rotation,
    hand_rotation,
    leg_rotation,
    solve_two_bone,
    v_length,
    v_scale,
)

q_multiply, q_rotate = compiled_inside(rotations.q_multiply), compiled_inside(rotations.q_rotate)
q_blend, q_inverse_multiply = (
    compiled_inside(rotations.q_blend),
    compiled_inside(rotations.q_inverse_multiply),
)
v_add, v_subtract = compiled_inside(rotations.v_add), compiled_inside(rotations.v_subtract)
IntArray = npt.NDArray[np.int64]
_KNEE_POLE: Vector = (0.0, 0.0, -1.0)
_SOFT_FROM = 0.95


@compiled
def _turn(local: FloatArray, joint: int) -> Quaternion:
    return local[joint, 0], local[joint, 1], local[joint, 2], local[joint, 3]


@compiled
def _set_turn(local: FloatArray, joint: int, q: Quaternion) -> None:
    local[joint, 0], local[joint, 1], local[joint, 2], local[joint, 3] = q


@compiled
def _offset(offsets: FloatArray, joint: int) -> Vector:
    return offsets[joint, 0], offsets[joint, 1], offsets[joint, 2]


@compiled
def between(
    frames: FloatArray, frame: int, share: float,
    rest: FloatArray | None = None, gains: FloatArray | None = None,
) -> FloatArray:  # fmt: skip
    """Return the local rotations (n, 4) a share of the way from a frame (N, n, 4) to the next.

    With `rest` (n, 4) and `gains` (n,) a joint's are rest + gain * that. All get length 1.
    """
    pose: FloatArray = np.empty_like(frames[frame])
    for joint in range(pose.shape[0]):
        for part in range(4):
            value = frames[frame, joint, part] * (1.0 - share)
            value += frames[frame + 1, joint, part] * share
            if rest is not None and gains is not None:
                value = rest[joint, part] + gains[joint] * value
            pose[joint, part] = value
        w, x, y, z = _turn(pose, joint)
        length = sqrt((w * w + y * y) + (x * x + z * z))
        _set_turn(pose, joint, (w / length, x / length, y / length, z / length))
    return pose


@compiled
def bend_trunk(local: FloatArray, joints: IntArray, x: float, z: float) -> None:
    """Turn each of the joints by the same small rotation, with half angles x and z."""
    scale = 1.0 / sqrt(1.0 + x * x + z * z)
    bend = (scale, scale * x, 0.0, scale * z)
    for joint in joints:
        _set_turn(local, joint, q_multiply(bend, _turn(local, joint)))


@compiled
def highest_hips(
    local: FloatArray, offsets: FloatArray, thighs: IntArray,
    hips_m: tuple[float, float], ankles: tuple[Vector, Vector], leg_m: float,
) -> float:  # fmt: skip
    """Return the greatest height of the hips at (x, z) from which legs of this length reach."""
    height = np.inf
    for side in range(2):
        ax, ay, az = ankles[side]
        sx, sy, sz = q_rotate(_turn(local, 0), _offset(offsets, thighs[side]))
        dx, dz = ax - hips_m[0] - sx, az - hips_m[1] - sz
        height = min(height, ay - sy + sqrt(max(leg_m * leg_m - dx * dx - dz * dz, 0.0)))
    return height


@compiled
def place_legs(
    local: FloatArray, offsets: FloatArray, thighs: IntArray, root_m: Vector,
    ankles: tuple[Vector, Vector], thigh_m: float, shank_m: float,
) -> None:  # fmt: skip
    """Place both ankles, with knees forward and feet flat and straight ahead."""
    hips = _turn(local, 0)
    for side in range(2):
        first = thighs[side]
        socket = v_add(root_m, q_rotate(hips, _offset(offsets, first)))
        limb = solve_two_bone(socket, ankles[side], thigh_m, shank_m, _KNEE_POLE)
        upper = leg_rotation(limb.upper, limb.normal)
        lower = leg_rotation(limb.lower, limb.normal)
        _set_turn(local, first, q_inverse_multiply(hips, upper))
        _set_turn(local, first + 1, q_inverse_multiply(upper, lower))
        _set_turn(local, first + 2, q_inverse_multiply(lower, IDENTITY))
        _set_turn(local, first + 3, IDENTITY)


@compiled
def _soft_reach(away_m: float, most_m: float) -> float:
    """Return how far an arm of the length `most_m` stretches towards a point at this distance.

    Up to 95 % of its length it stretches exactly as far; beyond, it approaches full length
    asymptotically, since an elbow that has to become straight abruptly would have to turn
    infinitely fast.
    """
    soft_m = _SOFT_FROM * most_m
    if away_m <= soft_m:
        return away_m
    room_m = most_m - soft_m
    return most_m - room_m * exp((soft_m - away_m) / room_m)


@compiled
def place_arm(
    local: FloatArray, offsets: FloatArray, above: IntArray, sign: float, root_m: Vector,
    tip_m: Vector, fingers: Vector, lengths_m: Vector, work: float,
) -> Vector:  # fmt: skip
    """Move a finger tip to `tip_m`, by the share `work`; return the way that the wrist falls short.

    `above`: the joints from the spine to the upper arm. `sign`: -1 left, 1 right. `lengths_m`:
    upper arm, forearm and hand.
    """
    upper_m, forearm_m, hand_m = lengths_m
    shoulder, turn = root_m, _turn(local, 0)
    for joint in above[:-1]:
        shoulder = v_add(shoulder, q_rotate(turn, _offset(offsets, joint)))
        turn = q_multiply(turn, _turn(local, joint))
    first = above[-1]
    shoulder = v_add(shoulder, q_rotate(turn, _offset(offsets, first)))
    way = v_subtract(v_subtract(tip_m, v_scale(fingers, hand_m)), shoulder)
    away = max(v_length(way), 1e-9)
    softly = _soft_reach(away, upper_m + forearm_m)
    wrist, pole = v_add(shoulder, v_scale(way, softly / away)), (0.35 * sign, -1.0, 0.25)
    limb = solve_two_bone(shoulder, wrist, upper_m, forearm_m, pole)
    upper = arm_rotation(limb.upper, limb.normal, sign)
    lower = arm_rotation(limb.lower, limb.normal, sign)
    hand = hand_rotation(fingers, limb.normal, sign)
    solved = (
        q_inverse_multiply(turn, upper),
        q_inverse_multiply(upper, lower),
        q_inverse_multiply(lower, hand),
    )
    for row in range(3):
        joint, rotation = first + row, solved[row]
        if work < 1.0:
            rotation = q_blend(_turn(local, joint), rotation, work)
        _set_turn(local, joint, rotation)
    return v_scale(way, (away - softly) / away)


@compiled
def blended(start: FloatArray, end: FloatArray, share: float) -> FloatArray:
    """Return each local rotation a share of the way from one pose to another, (n, 4)."""
    rotations_ = np.empty_like(start)
    for joint in range(start.shape[0]):
        _set_turn(rotations_, joint, q_blend(_turn(start, joint), _turn(end, joint), share))
    return rotations_


@compiled
def least_cosine(previous: FloatArray, pose: FloatArray) -> float:
    """Return the cosine of half the largest angle between two poses' local rotations (n, 4)."""
    least = 1.0
    for joint in range(pose.shape[0]):
        a, b = _turn(previous, joint), _turn(pose, joint)
        least = min(least, abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]))
    return least
