"""Resample movements of the 22 joints at a constant sampling rate, and turn them into loops.

A short recorded walk has to accompany a session of many minutes. So it is cut where the body's pose
is most similar to the beginning, that is after whole strides, and the end is cross-faded into the
start: over the overlap of L frames the loop goes from the old end to the beginning with a smooth
weight,

    loop[i] = slerp(clip[M - L + i], clip[i], s(i / L))   for i < L,
    loop[i] = clip[i]                                     for L <= i < M - L,

so that the frame after the last one, loop[0] = clip[M - L], is the clip's own next frame.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, geodesic_angle, shortest, slerp
from app.science.skeleton.model import SkeletonError

_SHORTEST_LOOP_S = 0.5


@dataclass(frozen=True, eq=False)
class Movement:
    """N frames of a body's movement in its own proportions, facing -z.

    Attributes:
        rate_hz: frames per second.
        root_positions_m: (N, 3) the hips in the world.
        rotations: (N, 22, 4) wxyz, parent_from_joint; joint 0 is world_from_hips.
        loops: whether frame 0 follows frame N - 1 smoothly.
    """

    rate_hz: float
    root_positions_m: FloatArray
    rotations: FloatArray
    loops: bool = False

    @property
    def frame_count(self) -> int:
        """Return the number of frames N."""
        return int(self.rotations.shape[0])

    @property
    def duration_s(self) -> float:
        """Return the time until the movement repeats, or to its last frame if it does not loop."""
        return (self.frame_count - (0 if self.loops else 1)) / self.rate_hz


def largest_step_rad(movement: Movement) -> float:
    """Return the largest rotation of any joint between consecutive frames, including a loop's seam.

    Raises:
        SkeletonError: fewer than two frames.
    """
    if movement.frame_count < 2:
        raise SkeletonError("A movement of one frame has no step: give at least two frames.")
    q = movement.rotations
    next_q = np.concatenate((q[1:], q[:1])) if movement.loops else q[1:]
    return float(np.max(geodesic_angle(q[: next_q.shape[0]], next_q)))


def resample(movement: Movement, rate_hz: float) -> Movement:
    """Return the movement at another sampling rate.

    Rotations are interpolated by slerp, root positions linearly.

    Raises:
        SkeletonError: the rate is not above zero, the movement loops (resample before looping) or
            has fewer than two frames.
    """
    if not rate_hz > 0.0 or not np.isfinite(rate_hz):
        raise SkeletonError(f"A rate of {rate_hz} Hz is not valid: it must be above zero.")
    if movement.loops or movement.frame_count < 2:
        raise SkeletonError(
            "Only a movement of two or more frames that does not loop yet can be"
            " resampled: resample before looping."
        )
    # The small tolerance keeps the last frame where the durations differ only by rounding.
    count = int(np.floor(movement.duration_s * rate_hz + 1e-6)) + 1
    positions = np.minimum(
        np.arange(count) * (movement.rate_hz / rate_hz), movement.frame_count - 1
    )
    previous = np.minimum(positions.astype(np.intp), movement.frame_count - 2)
    fraction = positions - previous
    root, q = movement.root_positions_m, movement.rotations
    line = fraction[:, np.newaxis]
    return Movement(
        rate_hz,
        root[previous] * (1.0 - line) + root[previous + 1] * line,
        slerp(q[previous], q[previous + 1], fraction[:, np.newaxis]),
    )


def loop(movement: Movement, crossfade_s: float = 0.4) -> Movement:
    """Return a loop of the movement's most repeatable stretch, cross-faded at the seam.

    Args:
        movement: a movement at least half a second longer than twice the cross-fade.
        crossfade_s: overlap that is blended. Longer is smoother and shortens the loop by as much.

    Raises:
        SkeletonError: the movement is too short or already loops.
    """
    overlap = round(crossfade_s * movement.rate_hz)
    shortest_end = 2 * overlap + round(_SHORTEST_LOOP_S * movement.rate_hz)
    if movement.loops or overlap < 1 or movement.frame_count < shortest_end:
        raise SkeletonError(
            f"{movement.frame_count} frames cannot be looped with a cross-fade of {crossfade_s} s:"
            f" {max(shortest_end, 2)} frames that do not loop yet are needed."
        )
    end = _most_similar_end(movement, overlap, max(shortest_end, movement.frame_count // 2))
    ramp = np.arange(overlap) / overlap
    weight = (ramp * ramp * (3.0 - 2.0 * ramp))[:, np.newaxis]
    q, root = movement.rotations, movement.root_positions_m
    seam = slerp(q[end - overlap : end], q[:overlap], weight)
    root_seam = root[end - overlap : end] * (1.0 - weight) + root[:overlap] * weight
    return Movement(
        movement.rate_hz,
        np.concatenate((root_seam, root[overlap : end - overlap])),
        continuous(np.concatenate((seam, q[overlap : end - overlap]))),
        loops=True,
    )


def _most_similar_end(movement: Movement, overlap: int, lowest: int) -> int:
    """Return the cut M whose last `overlap` frames are most similar to the first ones."""
    q = movement.rotations
    ends = range(lowest, movement.frame_count + 1)
    differences = [
        float(np.mean(geodesic_angle(q[end - overlap : end], q[:overlap]))) for end in ends
    ]
    return ends[int(np.argmin(differences))]


def continuous(rotations: FloatArray) -> FloatArray:
    """Choose q or -q in each frame, whichever is nearer to the previous frame's rotation."""
    dots = np.einsum("nji,nji->nj", rotations[1:], rotations[:-1])
    signs = np.cumprod(np.where(dots < 0.0, -1.0, 1.0), axis=0)
    result = rotations.copy()
    result[1:] *= signs[..., np.newaxis]
    return result


def mean_rotations(rotations: FloatArray) -> FloatArray:
    """Return each joint's chordal mean rotation over the frames, (22, 4).

    The mean q maximises the sum of (q . q_n)^2: the principal eigenvector of sum q_n q_n^T.
    Source: Markley et al. (2007), "Averaging quaternions", J. Guidance, Control and Dynamics 30.
    """
    outer = np.einsum("nji,njk->jik", rotations, rotations)
    _, vectors = np.linalg.eigh(outer)
    return shortest(np.ascontiguousarray(vectors[..., -1]))
