"""From the participant's pose to the angles that the avatar's hinges should take, and back.

The participant's body has 22 joints, each with a rotation parent_from_joint. The avatar's parts
turn about one to three axes (`parts.AXES_OF`), and some not at all: shoulders, and what a model
lacks. The rotation of what does not turn goes into the parts that hang on it, so these keep their
orientation in the world: the collar bone's into the upper arm, a missing chest's into the upper
chest.

Elbows and knees bend in one plane only, but trackers tell the turn of a bone about itself badly, so
the participant's bend may lie across it. Where an elbow cannot turn about its third axis, and at
the knee, the bone above is turned about itself until the hinge fits; forearm, shank and all below
keep their orientation in the world, and the bone above its direction. Likewise the forearm takes
over what the wrist cannot turn about the forearm's axis.

Angles are followed over time. Of the two ways to make a rotation about three axes, and of whole
turns, the one nearest to the last frame is taken, so the angles move without jumps through places
where a fixed formula has them. It is given up only where it would lead far out of the limits: for
the other way if that one lies at least 45 deg further in, all axes of the part together, and for a
whole turn where an angle is more than 225 deg from the middle of its range.

What is asked for may lie beyond the limits. `unclamped_rad` is unclamped, `angles_rad` is clamped;
`clipped` says which were. A part with fewer than three axes cannot take every rotation: it comes as
near as it can, and `residual_rad` says by how much it misses, before any clamping.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, PART_NAMES
from app.science.avatar.targets.target_plan import plan_targets
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX

AXIS_COUNT = len(AXES)
ROUNDING_RAD = 1e-6
"""Of what a limit takes. Single precision, in which poses travel, leaves a tenth of it: an elbow
that is held straight, at its limit, is not clipped in every other frame."""
_AT_ONCE = 512
"""Frames of a recording that are followed in a row; compiled code lets no other thread run."""
_JOINT_ROWS = np.array([PART_NAMES.index(name) for name in JOINT_INDEX])
_DIRECTIONS: FloatArray = np.array([axis.direction for axis in AXES])


class TargetError(ValueError):
    """A pose has the wrong shape, or limits are missing."""


class Limits(Protocol):
    """How far an axis turns: `axis_settings.AxisSettings` or `limits.AxisLimits`."""

    @property
    def low_rad(self) -> float: ...  # noqa: D102
    @property
    def high_rad(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, eq=False)
class Targets:
    """Angles of one frame, or of N frames; columns in the order of `AXIS_NAMES`.

    Attributes:
        angles_rad: (..., 91) within the limits; zero for axes of parts that are not there.
        wanted_rad: (..., 91) before clamping.
        residual_rad: (..., 52) in the order of `PART_NAMES`: how far the unclamped angles miss the
            part's rotation; zero for parts with three axes, and for parts without.
    """

    angles_rad: FloatArray
    unclamped_rad: FloatArray
    residual_rad: FloatArray

    @property
    def clipped(self) -> npt.NDArray[np.bool_]:
        """(..., 91) where the limits took something away, and be it `ROUNDING_RAD`."""
        return np.asarray(np.abs(self.unclamped_rad - self.angles_rad) > ROUNDING_RAD)

    def clipped_share(self) -> FloatArray:
        """(91,) share of the frames in which an axis was clipped."""
        shares: FloatArray = np.atleast_2d(self.clipped).mean(axis=0)
        return shares

    def velocities_rad_s(self, rate_hz: float) -> FloatArray:
        """(N, 91) speeds of the clamped angles by central differences, one-sided at the ends."""
        speeds: FloatArray = np.gradient(self.angles_rad, 1.0 / rate_hz, axis=0)
        return speeds


class TargetAngles:
    """Follows one participant, frame by frame; `batch` follows a whole recording.

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
        self._anew = True
        self._at_rest = identity(len(PART_NAMES))

    def forget(self) -> None:
        """Begin anew with the next frame, as after a gap in the tracking."""
        self._anew = True

    def batch(
        self,
        rotations: FloatArray,
        fingers: Mapping[str, FloatArray] | None = None,
        *,
        anew: npt.NDArray[np.bool_] | None = None,
    ) -> Targets:
        """Follow a recording from a new beginning: to the bit what `follow` gives frame by frame.

        Args:
            rotations: (N, 22, 4) as for `follow`, N above zero.
            fingers: (N, 4) by part name.
            anew: (N,) before which frames to `forget`; only before the first where it is left out.

        Raises:
            TargetError: a shape that does not fit.
        """
        if rotations.ndim != 3 or rotations.shape[0] == 0:
            raise TargetError(f"Rotations {rotations.shape} are not (N, 22, 4) with N above zero.")
        begins = np.zeros(rotations.shape[0], np.bool_) if anew is None else anew.copy()
        begins[0] = True
        given = fingers or {}
        found = [
            self._follow(rotations[at], {name: q[at] for name, q in given.items()}, begins[at])
            for at in (
                slice(first, first + _AT_ONCE) for first in range(0, len(rotations), _AT_ONCE)
            )
        ]
        return Targets(
            np.concatenate([frames.angles_rad for frames in found]),
            np.concatenate([frames.unclamped_rad for frames in found]),
            np.concatenate([frames.residual_rad for frames in found]),
        )

    def follow(
        self, rotations: FloatArray, fingers: Mapping[str, FloatArray] | None = None
    ) -> Targets:
        """Return the angles of one frame.

        Args:
            rotations: (22, 4) unit quaternions wxyz, parent_from_joint; the hips' row is not read.
                Where one is not finite, neither are the angles that follow from it, and the next
                frame is followed from the one before.
            fingers: parent_from_part (4,) of fingers by part name; others are at rest.

        Raises:
            TargetError: a shape that does not fit.
        """
        given = {name: q[np.newaxis] for name, q in (fingers or {}).items()}
        one = self._follow(rotations[np.newaxis], given, np.array([self._anew]))
        return Targets(one.angles_rad[0], one.unclamped_rad[0], one.residual_rad[0])

    def _follow(
        self,
        rotations: FloatArray,
        fingers: Mapping[str, FloatArray],
        anew: npt.NDArray[np.bool_],
    ) -> Targets:
        count = rotations.shape[0]
        if rotations.shape != (count, JOINT_COUNT, 4):
            raise TargetError(f"Rotations {rotations.shape[1:]} are not ({JOINT_COUNT}, 4).")
        local = np.empty((count, len(PART_NAMES), 4))
        local[:] = self._at_rest
        local[:, _JOINT_ROWS] = rotations
        for name, q in fingers.items():
            local[:, PART_NAMES.index(name)] = q
        angles, wanted = np.empty((2, count, AXIS_COUNT))
        residual = np.empty((count, len(PART_NAMES)))
        plan = self._plan
        self._hinges.follow_frames(
            local, anew, plan.folded, plan.bends, plan.bend_frames, plan.columns, plan.counts,
            plan.frames, plan.hands, plan.rows, plan.wrists,
            self.low_rad, self.high_rad, self._rest, self._followed, angles, wanted, residual,
        )  # fmt: skip
        self._anew = False
        return Targets(angles, wanted, residual)


def rotations_of(
    angles_rad: FloatArray, parts: Collection[str] = PART_NAMES
) -> dict[str, FloatArray]:
    """Return the rotation parent_from_part (..., 4) of each of the parts at angles (..., 91)."""
    columns = [column for column, axis in enumerate(AXES) if axis.part in parts]
    turns = from_rotation_vector(angles_rad[..., columns, np.newaxis] * _DIRECTIONS[columns])
    found = {part: identity(*angles_rad.shape[:-1]) for part in parts}
    for place, column in enumerate(columns):
        part = AXES[column].part
        found[part] = multiply(found[part], turns[..., place, :])
    return found


def joint_rotations(angles_rad: FloatArray, hips: FloatArray) -> FloatArray:
    """Return the 22 joints' local rotations (..., 22, 4) at angles (..., 91).

    Args:
        angles_rad: (..., 91).
        hips: (..., 4) world_from_hips.
    """
    parts = rotations_of(angles_rad, JOINT_INDEX)
    rows = [hips if name == "Hips" else parts[name] for name in JOINT_INDEX]
    return np.stack(np.broadcast_arrays(*rows), axis=-2)
