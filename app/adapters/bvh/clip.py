"""The content of a BVH file: its own skeleton, and one rotation per joint and frame."""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, multiply, rotate


class BvhError(ValueError):
    """A BVH text cannot be read.

    Attributes:
        line: line number from 1, or 0 for the whole text.
        reason: what is wrong and what is valid.
    """

    def __init__(self, line: int, reason: str) -> None:
        self.line = line
        self.reason = reason
        super().__init__(f"BVH line {line}: {reason}" if line else f"BVH: {reason}")


@dataclass(frozen=True)
class BvhLimits:
    """The largest sizes of a text that are accepted; real captures stay far below."""

    characters: int = 200_000_000
    joints: int = 512
    depth: int = 64
    values: int = 50_000_000


@dataclass(frozen=True, eq=False)
class BvhClip:
    """A capture in the file's own axes, lengths in metres.

    Attributes:
        names, parents: the J joints in file order; a parent precedes its children, -1 is the root.
        offsets_m: (J, 3) rest position in the parent's frame. All-identity rotations give the rest
            pose, which is often not a T-pose.
        end_sites: (joint, (x, y, z)) for each End Site: index of its joint and offset in metres.
        channels: the joint's channel names in file order, such as "Zrotation".
        frame_time_s: time from frame to frame.
        translations_m: (N, J, 3) position of each joint in its parent's frame; if a joint has
            position channels, they replace its offset, as is usual for the root.
        rotations: (N, J, 4) wxyz, parent_from_joint.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: FloatArray
    end_sites: tuple[tuple[int, tuple[float, float, float]], ...]
    channels: tuple[tuple[str, ...], ...]
    frame_time_s: float
    translations_m: FloatArray
    rotations: FloatArray

    @property
    def root_positions_m(self) -> FloatArray:
        """(N, 3) positions of the root in the file's world."""
        return self.translations_m[:, 0]

    @property
    def frame_count(self) -> int:
        """Number of frames N."""
        return int(self.rotations.shape[0])

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame."""
        return (self.frame_count - 1) * self.frame_time_s

    def world(self) -> tuple[FloatArray, FloatArray]:
        """Return positions in metres (N, J, 3) and world_from_joint rotations (N, J, 4)."""
        positions, rotations = np.empty_like(self.translations_m), np.empty_like(self.rotations)
        for joint, parent in enumerate(self.parents):
            if parent < 0:
                positions[:, joint] = self.translations_m[:, joint]
                rotations[:, joint] = self.rotations[:, joint]
                continue
            outer = rotations[:, parent]
            positions[:, joint] = positions[:, parent] + rotate(
                outer, self.translations_m[:, joint]
            )
            rotations[:, joint] = multiply(outer, self.rotations[:, joint])
        return positions, rotations
