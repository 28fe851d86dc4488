"""Compute the joint errors of a phase over time as its summary does, at a reduced rate."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry import Frames
from app.features.results.replay.grid import Grid, Indices, Sampling
from app.science.avatar.targets import HingeReference
from app.science.joint_error import ERROR_JOINTS, ReferenceMotion, joint_errors
from app.science.rotations import FloatArray


@dataclass
class RunErrors:
    """One run's avatar frames at the grid's moments, and the target frames with the same seq."""

    sampling: Sampling
    _moments: list[Indices] = field(default_factory=list)
    _seq: list[Indices] = field(default_factory=list)
    _actual: list[FloatArray] = field(default_factory=list)
    _targets: dict[int, tuple[float, FloatArray]] = field(default_factory=dict)

    def actual(self, piece: Frames) -> None:
        """Add a piece of the avatar's frames."""
        at, frames = self.sampling.take(piece)
        if not len(at):
            return
        self._moments.append(at)
        self._seq.append(frames.seq)
        self._actual.append(frames.rotations)

    def target(self, piece: Frames) -> None:
        """Add a piece of the participant's frames, after all of the avatar's frames."""
        rows = np.flatnonzero(np.isin(piece.seq, self._seqs))
        if not len(rows):
            return
        times_s, rotations = piece.times_s[rows], piece.rotations[rows]
        for row, seq in enumerate(piece.seq[rows]):
            self._targets[int(seq)] = (float(times_s[row]), rotations[row])

    def fill(self, errors_rad: NDArray[np.float32], hinges: HingeReference | None) -> None:
        """Write the angles (21) of each moment that has both frames to `errors_rad`."""
        if not self._moments:
            return
        at, seqs = np.concatenate(self._moments), self._seqs
        paired = np.flatnonzero([int(seq) in self._targets for seq in seqs])
        if not len(paired):
            return
        partners = [self._targets[int(seqs[row])] for row in paired]
        times_s = np.array([time_s for time_s, _ in partners])
        rotations = np.stack([rotation for _, rotation in partners])
        reference = (
            ReferenceMotion(rotations) if hinges is None else hinges.recording(times_s, rotations)
        )
        found = joint_errors(reference.rotations, np.concatenate(self._actual)[paired])
        counts = found.valid
        if reference.clipping is not None:
            counts = counts & reference.clipping.hinged
        errors_rad[at[paired]] = np.where(counts, found.values_rad[..., 0], np.nan)

    @property
    def _seqs(self) -> Indices:
        return np.concatenate(self._seq) if self._seq else np.empty(0, np.int64)


def no_errors(grid: Grid) -> NDArray[np.float32]:
    """Return an array of missing errors for a grid: (count, 21) NaN."""
    return np.full((grid.count, len(ERROR_JOINTS)), np.nan, np.float32)
