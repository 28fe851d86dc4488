"""Sound recordings of moving bodies, and faults put into them at known places."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.science import rotations as rot
from app.science.skeleton import JOINT_COUNT, loop, resample
from app.simulated_people.body import captured_movement
from tests.science.simulation.people import (
    BOXES,
    RATE_HZ,
    SKELETON,
    follow,
    person_of,
    reach,
    step,
)

CAPTURES = ("02_01.bvh", "06_01.bvh")


@dataclass(frozen=True)
class Recording:
    """Times (n,), rotations (n, 22, 4) and positions (n, 3), single precision as transmitted."""

    times_s: NDArray[np.float64]
    rotations: NDArray[np.float32]
    positions_m: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.times_s)

    def copy(self) -> "Recording":
        """Return a copy that may be changed."""
        return Recording(self.times_s.copy(), self.rotations.copy(), self.positions_m.copy())

    def part(self, of: slice) -> "Recording":
        """Return a slice of its frames."""
        return Recording(self.times_s[of], self.rotations[of], self.positions_m[of])

    def without(self, frames: NDArray[np.int64]) -> "Recording":
        """Return the recording without these frames."""
        mask = np.ones(len(self), np.bool_)
        mask[frames] = False
        return replace(
            self,
            times_s=self.times_s[mask],
            rotations=self.rotations[mask],
            positions_m=self.positions_m[mask],
        )


@lru_cache(maxsize=8)
def generated(seed: int = 1) -> Recording:
    """Return half a minute of tasks and free movement by a simulated participant."""
    person = person_of(seed, None)
    goals = [None, reach(BOXES[0]), reach(BOXES[3]), reach(BOXES[1], "Left"), None]
    goals += [step((0.2, 0.01, -0.5), "Right"), None]
    poses = [pose for at, goal in enumerate(goals) for pose in follow(person, goal, 4.0 * at, 4.0)]
    return Recording(
        np.arange(len(poses)) / RATE_HZ,
        np.stack([pose.rotations for pose in poses]).astype(np.float32),
        np.stack([pose.root_position_m for pose in poses]).astype(np.float32),
    )


@lru_cache(maxsize=4)
def captured(file: Path) -> Recording:
    """Return a capture of a person, repeated to half a minute."""
    clip = captured_movement(file, SKELETON)
    movement = loop(resample(clip, RATE_HZ))
    frames = np.arange(round(30 * RATE_HZ)) % len(movement.rotations)
    return Recording(
        np.arange(len(frames)) / RATE_HZ,
        movement.rotations[frames].astype(np.float32),
        movement.root_positions_m[frames].astype(np.float32),
    )


def captures(shared_data: Path) -> list[Recording]:
    """Return every capture that has no faults of its own."""
    return [captured(shared_data / "motion" / "cmu_bvh" / name) for name in CAPTURES]


def jitter(recording: Recording, rng: np.random.Generator) -> Recording:
    """Return the recording with tracker noise: a hundredth of a degree and 0.3 ms."""
    noisy = recording.copy()
    noise = rng.normal(scale=np.radians(0.01), size=(len(recording), JOINT_COUNT, 3))
    shaken = rot.multiply(rot.from_rotation_vector(noise), recording.rotations.astype(float))
    noisy.rotations[:] = shaken
    noisy.times_s[:] += rng.normal(scale=0.0003, size=len(recording))
    return noisy


@dataclass(frozen=True)
class Found:
    """Counts of inserted faults, of those that were found, and of false alarms."""

    there: int
    hits: int
    false: int

    @property
    def precision(self) -> float:
        """Return the share of found faults that had been inserted."""
        return self.hits / max(1, self.hits + self.false)

    @property
    def recall(self) -> float:
        """Return the share of inserted faults that were found."""
        return self.hits / max(1, self.there)

    def __add__(self, other: "Found") -> "Found":
        return Found(self.there + other.there, self.hits + other.hits, self.false + other.false)

    def line(self, what: str) -> str:
        """Format the counts as a line of the log."""
        return (
            f"{what:<34}{self.there:>7} there, {self.hits:>7} found, {self.false:>4} false:"
            f" precision {self.precision:.4f}, recall {self.recall:.4f}"
        )


def compare(there: NDArray[np.bool_], found: NDArray[np.bool_]) -> Found:
    """Count inserted, found and falsely found faults from two masks."""
    return Found(int(there.sum()), int((there & found).sum()), int((found & ~there).sum()))
