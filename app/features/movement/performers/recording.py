"""Record a performer's own movement, and bring it to a constant rate.

Frames are kept in memory, in blocks, until the recording is stored as a capture: one that is not
stored is gone when the server ends. Sources seldom keep their rate exactly, and captures have one,
so the movement is interpolated; where nothing came there is a gap, which is named.
"""

from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.features.movement.performers.assembly import SAME_M, BodyFrame
from app.features.movement.performers.performer import PerformerName
from app.science.rig import BoolArray, Rig, RigMotion
from app.science.rotations import FloatArray, normalise, slerp

Float32Array = npt.NDArray[np.float32]
RecordingState = Literal["running", "ended", "full", "changed"]
"""`ended` by somebody. `full`: as long as one may be. `changed`: it is another skeleton now."""
LONGEST_S = 600.0
BYTES_PER_NUMBER = 12
"""The most bytes of a number in a BVH file, such as "-179.999999 "."""
BLOCK = 512
GAP = 3.0
"""Frames further apart than this many usual intervals have a gap between them."""
_EVEN = 0.005
"""A rate this near to a whole number is that number."""
_STEADY = 0.05
"""A source's clock that runs this much faster or slower than ours does not count seconds."""
_AT_ONCE = 4096


@dataclass(frozen=True)
class Gap:
    """A time in which nothing came, in seconds from the beginning."""

    from_s: float
    to_s: float


@dataclass(frozen=True, eq=False)
class Recorded:
    """The frames of a recording, which need not be at a constant rate.

    Attributes:
        rig: the skeleton, with the agreed T-pose at rest.
        times_s: (N,) increasing.
        roots_m, rotations, observed: (N, 3), (N, J, 4) and (N, J), as in `RigMotion`.
    """

    rig: Rig
    times_s: FloatArray
    roots_m: Float32Array
    rotations: Float32Array
    observed: BoolArray


@dataclass(eq=False)
class Recording:
    """A recording that goes on, or has ended and waits to be stored.

    `limit_s` is as long as it may be, so that its file stays below the limit of captures.
    """

    id: str
    name: PerformerName
    rig: Rig
    by: str
    since: datetime
    limit_s: float
    max_frames: int
    state: RecordingState = "running"
    frames: int = 0
    first_s: float | None = None
    last_s: float | None = None
    _source_s: list[float | None] = field(default_factory=list)
    _mapped_s: list[float] = field(default_factory=list)
    _blocks: list[tuple[Float32Array, Float32Array, BoolArray]] = field(default_factory=list)

    @property
    def duration_s(self) -> float:
        """Seconds between its first and its newest frame."""
        return 0.0 if self.first_s is None or self.last_s is None else self.last_s - self.first_s

    def take(self, frame: BodyFrame) -> None:
        """Add a frame; end the recording if it is full or the skeleton is another one."""
        if self.state != "running":
            return
        if not is_same(self.rig, frame.skeleton.rig):
            self.state = "changed"
            return
        first_s = frame.arrival_s if self.first_s is None else self.first_s
        if frame.arrival_s - first_s > self.limit_s or self.frames >= self.max_frames:
            self.state = "full"
            return
        self.first_s, self.last_s = first_s, frame.arrival_s
        row = self.frames % BLOCK
        if row == 0:
            joints = self.rig.joint_count
            self._blocks.append(
                (
                    np.empty((BLOCK, 3), dtype=np.float32),
                    np.empty((BLOCK, joints, 4), dtype=np.float32),
                    np.empty((BLOCK, joints), dtype=np.bool_),
                )
            )
        roots, rotations, observed = self._blocks[-1]
        roots[row], rotations[row], observed[row] = frame.root_m, frame.rotations, frame.observed
        self._source_s.append(frame.source_s)
        self._mapped_s.append(frame.mapped_s)
        self.frames += 1

    def recorded(self) -> Recorded:
        """Return what was recorded so far; there must be a frame."""
        roots, rotations, observed = (
            np.concatenate(parts)[: self.frames] for parts in zip(*self._blocks, strict=True)
        )
        times_s = _times_s(self._source_s, self._mapped_s)
        # A time that does not go on, after a restart of the source, is no frame of its own.
        on = np.concatenate(([True], np.diff(np.maximum.accumulate(times_s)) > 0.0))
        return Recorded(self.rig, times_s[on], roots[on], rotations[on], observed[on])


def is_same(rig: Rig, other: Rig) -> bool:
    """Return whether two skeletons have the same bones of the same lengths."""
    return rig is other or (
        rig.fingerprint == other.fingerprint
        and float(np.abs(rig.offsets_m - other.offsets_m).max()) <= SAME_M
    )


def _times_s(source_s: list[float | None], mapped_s: list[float]) -> FloatArray:
    """Return the source's own times, if it has a clock that runs on like ours."""
    mapped = np.array(mapped_s)
    known = [one for one in source_s if one is not None]
    own = np.array(known)
    if len(known) < len(mapped) or len(own) < 2 or not (np.diff(own) > 0.0).all():
        return mapped
    ours_s, theirs_s = mapped[-1] - mapped[0], own[-1] - own[0]
    return own if abs(theirs_s - ours_s) <= _STEADY * ours_s else mapped


def at_constant_rate(recorded: Recorded) -> tuple[RigMotion, tuple[Gap, ...]]:
    """Return the movement at its usual rate, and its gaps.

    Rotations are interpolated by slerp, the root linearly. Joints count as not observed in gaps,
    and where they were not observed in both frames around.
    """
    times = recorded.times_s - recorded.times_s[0]
    rig, roots, rotations = recorded.rig, recorded.roots_m.astype(np.float64), recorded.rotations
    if len(times) < 2:
        return _motion(rig, 1.0, roots, rotations.astype(np.float64), recorded.observed), ()
    steps = np.diff(times)
    is_gap = steps > GAP * float(np.median(steps))
    rate_hz = 1.0 / float(steps[~is_gap].mean())
    whole = round(rate_hz)
    if whole > 0 and abs(rate_hz - whole) <= _EVEN * whole:
        rate_hz = float(whole)
    count = int(np.floor(times[-1] * rate_hz + 1e-3)) + 1
    at_s = np.minimum(np.arange(count) / rate_hz, times[-1])
    after = np.clip(np.searchsorted(times, at_s), 1, len(times) - 1)
    share = (at_s - times[after - 1]) / steps[after - 1]
    before = after - 1
    moved = roots[before] + share[:, np.newaxis] * (roots[after] - roots[before])
    turned = np.empty((count, rig.joint_count, 4))
    for first in range(0, count, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        turned[part] = slerp(
            rotations[before[part]].astype(np.float64),
            rotations[after[part]].astype(np.float64),
            share[part, np.newaxis],
        )
    observed = recorded.observed[before] & recorded.observed[after] & ~is_gap[before, np.newaxis]
    gaps = tuple(
        Gap(float(times[at]), float(times[at + 1])) for at in np.flatnonzero(is_gap).tolist()
    )
    return _motion(rig, rate_hz, moved, turned, observed), gaps


def _motion(
    rig: Rig, rate_hz: float, roots_m: FloatArray, rotations: FloatArray, observed: BoolArray
) -> RigMotion:
    return RigMotion(rig, rate_hz, roots_m, normalise(rotations), observed)
