"""Convert the participant's pose to the target angles of the avatar's hinges, and back.

The participant's body has 22 joints, each with a rotation parent_from_joint. The avatar's parts
turn about one to three axes (`parts.AXES_OF`), and some do not turn: shoulders, and parts that a
model lacks. The rotation of a joint that does not turn is transferred to the parts attached to it,
so these keep their orientation in the world: the collar bone's goes to the upper arm, a missing
chest's to the upper chest.

Elbows and knees bend in one plane only, but trackers measure the rotation of a bone about its own
axis poorly, so the participant's bend may lie across that plane. Where an elbow cannot turn about
its third axis, and at the knee, the bone above is turned about its own axis until the hinge fits;
forearm, shank and all parts below keep their orientation in the world, and the bone above its
direction. Likewise the forearm takes over what the wrist cannot turn about the forearm's axis.

Angles are followed over time. Of the two solutions for a rotation about three axes, and of angles
that differ by whole turns, the one nearest to the last frame is taken, so the angles move without
jumps where a fixed formula would jump. This choice is given up only where it would lead far beyond
the limits: for the other solution if that one lies at least 45 deg further within them, all axes of
the part together, and for a whole turn where an angle is more than 225 deg from the middle of its
range.

Target angles may lie beyond the limits. `unclamped_rad` is unclamped, `angles_rad` is clamped;
`clipped` says where they differ. A part with fewer than three axes cannot take every rotation: it
comes as near as it can, and `residual_rad` is the angle that remains, before any clamping.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, AXES_OF, PART_NAMES
from app.science.avatar.targets.target_plan import plan_targets
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply
from app.science.skeleton import FINGER_PARTS, JOINT_COUNT, JOINT_INDEX

AXIS_COUNT = len(AXES)
ROUNDING_RAD = 1e-6
"""Least change by a limit that counts as clipping. Poses are sent in single precision, whose
rounding is a tenth of it: an elbow held straight, at its limit, is not clipped in every other
frame."""
_CHUNK_FRAMES = 512
"""Frames of a recording per call of the compiled code, which does not let other threads run."""


def _runs(rows: Sequence[int]) -> Iterator[tuple[slice, slice]]:
    """Yield slices of consecutive rows, and of the positions that these have among `rows`."""
    first = 0
    for at in range(1, len(rows) + 1):
        if at == len(rows) or rows[at] != rows[at - 1] + 1:
            yield slice(rows[first], rows[at - 1] + 1), slice(first, at)
            first = at


_ROW_OF = {name: row for row, name in enumerate(PART_NAMES)}
_JOINT_RUNS = tuple(_runs([PART_NAMES.index(name) for name in JOINT_INDEX]))
_FINGER_RUNS = tuple(_runs([PART_NAMES.index(name) for name in FINGER_PARTS]))
"""Which rows of all parts are which joints and fingers, as slices, which are copied fastest."""
_RESTARTS, _GOES_ON = np.array([True]), np.array([False])
_DIRECTIONS: FloatArray = np.array([axis.direction for axis in AXES])
# Every finger part has one axis; those at the knuckles have a second one.
_FIRST_AXES = np.array([AXES.index(AXES_OF[part][0]) for part in FINGER_PARTS])
_TWO_AXES = np.array([row for row, part in enumerate(FINGER_PARTS) if len(AXES_OF[part]) == 2])
_SECOND_AXES = _FIRST_AXES[_TWO_AXES] + 1


Fingers = FloatArray | Mapping[str, FloatArray]
"""Rotations parent_from_part of fingers: of all in the order of `FINGER_PARTS`, (..., 30, 4), or of
some by name, (..., 4)."""


class TargetError(ValueError):
    """A pose has the wrong shape, or limits are missing."""


class Limits(Protocol):
    """Range of an axis: `axis_settings.AxisSettings` or `limits.AxisLimits`."""

    @property
    def low_rad(self) -> float: ...  # noqa: D102
    @property
    def high_rad(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, eq=False)
class Targets:
    """Target angles of one frame, or of N frames; columns in the order of `AXIS_NAMES`.

    Attributes:
        angles_rad: (..., 91) angles within the limits; zero for axes of absent parts.
        unclamped_rad: (..., 91) angles before clamping.
        residual_rad: (..., 52) in the order of `PART_NAMES`: angle between the part's rotation and
            the one that the unclamped angles make; zero for parts with three axes, and for parts
            without any.
    """

    angles_rad: FloatArray
    unclamped_rad: FloatArray
    residual_rad: FloatArray

    @property
    def clipped(self) -> npt.NDArray[np.bool_]:
        """Return whether the limits changed each angle by more than `ROUNDING_RAD`, (..., 91)."""
        return np.asarray(np.abs(self.unclamped_rad - self.angles_rad) > ROUNDING_RAD)

    def clipped_share(self) -> FloatArray:
        """Return the share of the frames in which each axis was clipped, (91,)."""
        shares: FloatArray = np.atleast_2d(self.clipped).mean(axis=0)
        return shares

    def velocities_rad_s(self, rate_hz: float) -> FloatArray:
        """Return the speeds of the clamped angles by central differences, (N, 91).

        At the ends the differences are one-sided.
        """
        speeds: FloatArray = np.gradient(self.angles_rad, 1.0 / rate_hz, axis=0)
        return speeds


class TargetAngles:
    """Computes the target angles of one participant's poses, frame by frame or as a `batch`.

    Args:
        limits: axis name -> limits, of every axis of every present part.
        parts: names of the avatar's parts.

    Raises:
        TargetError: an axis has no limits.
    """

    def __init__(self, limits: Mapping[str, Limits], parts: Collection[str] = PART_NAMES) -> None:
        from app.science.avatar.targets import hinge_angles  # loads the compiler

        self._hinges = hinge_angles
        missing = [axis.name for axis in AXES if axis.part in parts and axis.name not in limits]
        if missing:
            raise TargetError(f"The axis {missing[0]} has no limits: give them for every axis.")
        given = [limits[axis.name] if axis.part in parts else None for axis in AXES]
        self.low_rad: FloatArray = np.array([one.low_rad if one else 0.0 for one in given])
        self.high_rad: FloatArray = np.array([one.high_rad if one else 0.0 for one in given])
        self._rest: FloatArray = np.clip(np.zeros(AXIS_COUNT), self.low_rad, self.high_rad)
        locked = frozenset(
            axis.name
            for axis, low, high in zip(AXES, self.low_rad, self.high_rad, strict=True)
            if low == high
        )
        self._plan = plan_targets(parts, locked)
        self._followed: FloatArray = self._rest.copy()
        self._restart = True
        self._at_rest = identity(len(PART_NAMES))

    def forget(self) -> None:
        """Forget the previous frames, as after a gap in the tracking.

        The next frame is followed from the rest angles.
        """
        self._restart = True

    def batch(
        self,
        rotations: FloatArray,
        fingers: Fingers | None = None,
        *,
        restarts: npt.NDArray[np.bool_] | None = None,
    ) -> Targets:
        """Return the target angles of a recording, followed from its first frame.

        The result is bitwise the same as that of `follow` frame by frame.

        Args:
            rotations: (N, 22, 4) rotations as for `follow`, with N above zero.
            fingers: as for `follow`, of N frames.
            restarts: (N,) whether to `forget` before each frame; None for the first one only.

        Raises:
            TargetError: a shape does not fit.
        """
        if rotations.ndim != 3 or rotations.shape[0] == 0:
            raise TargetError(f"Rotations {rotations.shape} are not (N, 22, 4) with N above zero.")
        starts = np.zeros(rotations.shape[0], np.bool_) if restarts is None else restarts.copy()
        starts[0] = True
        chunks = [
            self._follow(rotations[at], _at(fingers, at), starts[at])
            for at in (
                slice(first, first + _CHUNK_FRAMES)
                for first in range(0, len(rotations), _CHUNK_FRAMES)
            )
        ]
        return Targets(
            np.concatenate([frames.angles_rad for frames in chunks]),
            np.concatenate([frames.unclamped_rad for frames in chunks]),
            np.concatenate([frames.residual_rad for frames in chunks]),
        )

    def follow(self, rotations: FloatArray, fingers: Fingers | None = None) -> Targets:
        """Return the target angles of one frame.

        Args:
            rotations: (22, 4) unit quaternions wxyz, parent_from_joint; the hips' row is not read.
                Where one is not finite, neither are the angles that depend on it, and the next
                frame is followed from the previous one.
            fingers: rotations of the fingers; others are at rest.

        Raises:
            TargetError: a shape does not fit.
        """
        given = _at(fingers, np.newaxis)
        target = self._follow(
            rotations[np.newaxis], given, _RESTARTS if self._restart else _GOES_ON
        )
        return Targets(target.angles_rad[0], target.unclamped_rad[0], target.residual_rad[0])

    def _follow(
        self,
        rotations: FloatArray,
        fingers: Fingers | None,
        restarts: npt.NDArray[np.bool_],
    ) -> Targets:
        count = rotations.shape[0]
        if rotations.shape != (count, JOINT_COUNT, 4):
            raise TargetError(f"Rotations {rotations.shape[1:]} are not ({JOINT_COUNT}, 4).")
        local = np.empty((count, len(PART_NAMES), 4))
        local[:] = self._at_rest
        for into, of in _JOINT_RUNS:
            local[:, into] = rotations[:, of]
        if isinstance(fingers, np.ndarray):
            for into, of in _FINGER_RUNS:
                local[:, into] = fingers[:, of]
        elif fingers is not None:
            for name, q in fingers.items():
                local[:, _ROW_OF[name]] = q
        angles, unclamped = np.empty((2, count, AXIS_COUNT))
        residual = np.empty((count, len(PART_NAMES)))
        plan = self._plan
        self._hinges.follow_frames(
            local, restarts, plan.folded, plan.bends, plan.bend_frames, plan.columns, plan.counts,
            plan.frames, plan.hands, plan.rows, plan.wrists,
            self.low_rad, self.high_rad, self._rest, self._followed, angles, unclamped, residual,
        )  # fmt: skip
        self._restart = False
        return Targets(angles, unclamped, residual)


def _at(fingers: Fingers | None, at: slice | None) -> Fingers | None:
    """Return the fingers in some of N frames, or of one frame as of N = 1."""
    if fingers is None or isinstance(fingers, np.ndarray):
        return None if fingers is None else fingers[at]
    return {name: q[at] for name, q in fingers.items()}


def rotations_of(
    angles_rad: FloatArray, parts: Collection[str] = PART_NAMES
) -> dict[str, FloatArray]:
    """Return the rotation parent_from_part (..., 4) of each of the parts at angles (..., 91)."""
    columns = [column for column, axis in enumerate(AXES) if axis.part in parts]
    turns = from_rotation_vector(angles_rad[..., columns, np.newaxis] * _DIRECTIONS[columns])
    rotations = {part: identity(*angles_rad.shape[:-1]) for part in parts}
    for index, column in enumerate(columns):
        part = AXES[column].part
        rotations[part] = multiply(rotations[part], turns[..., index, :])
    return rotations


def finger_rotations(angles_rad: FloatArray) -> FloatArray:
    """Return the local rotations of the fingers (..., 30, 4) at angles (..., 91)."""
    turns = _turns(angles_rad, _FIRST_AXES)
    second = _turns(angles_rad, _SECOND_AXES)
    turns[..., _TWO_AXES, :] = multiply(turns[..., _TWO_AXES, :], second)
    return turns


def _turns(angles_rad: FloatArray, columns: npt.NDArray[np.int64]) -> FloatArray:
    return from_rotation_vector(angles_rad[..., columns, np.newaxis] * _DIRECTIONS[columns])


def joint_rotations(angles_rad: FloatArray, hips: FloatArray) -> FloatArray:
    """Return the local rotations of the 22 joints (..., 22, 4) at angles (..., 91).

    Args:
        angles_rad: (..., 91) angles in the order of `AXIS_NAMES`.
        hips: (..., 4) rotation world_from_hips.
    """
    parts = rotations_of(angles_rad, JOINT_INDEX)
    rows = [hips if name == "Hips" else parts[name] for name in JOINT_INDEX]
    return np.stack(np.broadcast_arrays(*rows), axis=-2)
