"""The background movement of a person, which continues while the limbs do a task."""

import numpy as np

from app.science.rotations import FloatArray, Vector
from app.science.simulation.goal import SimulationError
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX, Movement, mean_rotations

# The share of the base movement, around its mean, that remains during a task. A walk must not
# stride in front of the boxes, but the body must not freeze either; the steps place the legs.
_TASK_GAIN = {"Hips": 0.25, "Neck": 0.6, "Head": 0.6}
_TASK_GAIN_ELSE = 0.35
_LEG_JOINTS = range(JOINT_INDEX["LeftUpperLeg"], JOINT_COUNT)
_SWAY_GAIN = 0.25


class BaseMovement:
    """Plays back a looping movement at any time, in full or damped for a task."""

    def __init__(self, movement: Movement, offset_s: float) -> None:
        from app.science.simulation import posture_kernels  # loads the compiler

        self._kernels = posture_kernels
        if not movement.loops:
            raise SimulationError("The base movement must loop: pass it through `loop` first.")
        q, root = movement.rotations, movement.root_positions_m
        self._rate_hz, self._frames, self._offset_s = movement.rate_hz, q.shape[0], offset_s
        mean = mean_rotations(q)
        q = q * np.where(np.einsum("ji,ji->j", q[0], mean) < 0.0, -1.0, 1.0)[:, np.newaxis]
        # The first frame is appended, in the last one's hemisphere, to interpolate over the seam.
        seam = q[0] * np.where(np.einsum("ji,ji->j", q[0], q[-1]) < 0.0, -1.0, 1.0)[:, np.newaxis]
        self._rotations = np.concatenate((q, seam[np.newaxis]))
        # As plain numbers, since one row is read at a time.
        self._roots: list[list[float]] = [*root.tolist(), root[0].tolist()]
        gains = np.full(JOINT_COUNT, _TASK_GAIN_ELSE)
        for name, gain in _TASK_GAIN.items():
            gains[JOINT_INDEX[name]] = gain
        gains[_LEG_JOINTS] = 0.0
        self._gains, self._rest = gains, (1.0 - gains)[:, np.newaxis] * mean
        self._middle: list[float] = root.mean(axis=0).tolist()

    @property
    def offset_s(self) -> float:
        """The place in the loop at time 0."""
        return self._offset_s

    def _frame_at(self, time_s: float) -> tuple[int, float]:
        place = ((time_s + self._offset_s) * self._rate_hz) % self._frames
        frame = min(int(place), self._frames - 1)
        return frame, place - frame

    def root(self, time_s: float) -> Vector:
        """Return the position of the hips, x and z around the origin, as recorded."""
        frame, share = self._frame_at(time_s)
        x, y, z = self._roots[frame]
        to_x, to_y, to_z = self._roots[frame + 1]
        rest = 1.0 - share
        return x * rest + to_x * share, y * rest + to_y * share, z * rest + to_z * share

    def sway(self, time_s: float) -> tuple[float, float]:
        """Return the damped sway of the hips during a task: x and z in metres."""
        x, _, z = self.root(time_s)
        return _SWAY_GAIN * (x - self._middle[0]), _SWAY_GAIN * (z - self._middle[2])

    def whole(self, time_s: float) -> FloatArray:
        """Return the local rotations (22, 4) as recorded."""
        frame, share = self._frame_at(time_s)
        return self._kernels.between(self._rotations, frame, share)

    def damped(self, time_s: float) -> FloatArray:
        """Return the local rotations (22, 4), damped towards their mean; those of legs are it."""
        frame, share = self._frame_at(time_s)
        return self._kernels.between(self._rotations, frame, share, self._rest, self._gains)
