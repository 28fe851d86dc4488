"""Define a skeleton of any kind, and its movement.

The world is y up and right-handed, lengths are metres, rotations unit quaternions wxyz. A rig's
*rest pose* is the pose that its file or its author defines as such; it need not be a T-pose
(`app.science.retargeting.t_pose` makes one). In order of joints, with q_j the local rotation,

    world_from_j = world_from_parent q_j
    p_j = p_parent + world_from_parent o_j,   p_root = root position.
"""

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray, conjugate, multiply, normalise, rotate

BoolArray = npt.NDArray[np.bool_]


class RigError(ValueError):
    """A rig or movement is invalid: wrong order of parents, wrong array shape, or unknown joint."""


@dataclass(frozen=True, eq=False)
class Rig:
    """A tree of joints, each with a position and a rotation in its parent at rest.

    Attributes:
        names, parents: the J joints; the root comes first with parent -1, and a parent precedes its
        children.
        offsets_m: (J, 3) rest position in the parent's frame; the root's row is its rest position
            in the world, zero where the file gives none.
        rest_rotations: (J, 4) parent_from_joint at rest; the root's row is world_from_root.
        ends: (joint, (x, y, z)) for each free end of a bone, in the joint's frame, metres.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: FloatArray
    rest_rotations: FloatArray
    ends: tuple[tuple[int, tuple[float, float, float]], ...] = ()

    def __post_init__(self) -> None:
        """Raise RigError if names, parents and arrays do not fit each other."""
        count = len(self.names)
        if count == 0 or len(set(self.names)) != count:
            raise RigError("A rig needs at least one joint, and each needs a unique name.")
        wrong = [
            name
            for joint, (name, parent) in enumerate(zip(self.names, self.parents, strict=True))
            if not (parent == -1 if joint == 0 else 0 <= parent < joint)
        ]
        if wrong:
            raise RigError(
                f"Joint {wrong[0]!r} has no parent before it: list the one root first, then"
                " parents before their children."
            )
        if self.offsets_m.shape != (count, 3) or self.rest_rotations.shape != (count, 4):
            raise RigError(
                f"{count} joints need offsets ({count}, 3) and rest rotations ({count}, 4), got"
                f" {self.offsets_m.shape} and {self.rest_rotations.shape}."
            )
        if not (np.isfinite(self.offsets_m).all() and np.isfinite(self.rest_rotations).all()):
            raise RigError("Offsets and rest rotations must be finite.")

    @property
    def joint_count(self) -> int:
        """Return the number of joints J."""
        return len(self.names)

    @property
    def fingerprint(self) -> str:
        """Return the hash of names and hierarchy; rigs with the same one can share a joint map."""
        text = "\n".join(f"{n}\t{p}" for n, p in zip(self.names, self.parents, strict=True))
        return hashlib.sha256(text.encode()).hexdigest()

    def index(self, name: str) -> int:
        """Return the index of the joint with this name; raises RigError with the valid names."""
        try:
            return self.names.index(name)
        except ValueError:
            valid = ", ".join(self.names)
            raise RigError(f"The skeleton has no joint {name!r}: it has {valid}.") from None

    def children(self, joint: int) -> tuple[int, ...]:
        """Return the joints whose parent is this one."""
        return tuple(child for child, parent in enumerate(self.parents) if parent == joint)

    def rest_world(self) -> tuple[FloatArray, FloatArray]:
        """Return the positions (J, 3) and world_from_joint (J, 4) of the rest pose, read-only."""
        return self._rest_world

    @cached_property
    def _rest_world(self) -> tuple[FloatArray, FloatArray]:
        placed = to_world(self, self.offsets_m[0], self.rest_rotations)
        for array in placed:
            array.flags.writeable = False
        return placed


@dataclass(frozen=True, eq=False)
class RigMotion:
    """N frames of a rig at a constant sampling rate.

    Attributes:
        rig: the skeleton that moves.
        rate_hz: frames per second.
        root_positions_m: (N, 3) the root in the world.
        rotations: (N, J, 4) parent_from_joint; column 0 is world_from_root. They are complete
            rotations, not relative to the rest pose.
        observed: (N, J) mask, false where a value was missing in the file and filled in.
    """

    rig: Rig
    rate_hz: float
    root_positions_m: FloatArray
    rotations: FloatArray
    observed: BoolArray

    def __post_init__(self) -> None:
        """Raise RigError if the arrays' shapes do not fit together."""
        frames, joints = self.rotations.shape[:1], self.rig.joint_count
        fits = (
            self.rotations.shape == (*frames, joints, 4)
            and self.root_positions_m.shape == (*frames, 3)
            and self.observed.shape == (*frames, joints)
        )
        if not fits or self.frame_count == 0 or not self.rate_hz > 0.0:
            raise RigError(
                f"Root positions {self.root_positions_m.shape}, rotations {self.rotations.shape}"
                f" and observed {self.observed.shape} at {self.rate_hz} Hz are not a movement of"
                f" {joints} joints: give (N, 3), (N, {joints}, 4), (N, {joints}) and a rate."
            )

    @property
    def frame_count(self) -> int:
        """Return the number of frames N."""
        return int(self.rotations.shape[0])

    @property
    def duration_s(self) -> float:
        """Return the time from the first to the last frame."""
        return (self.frame_count - 1) / self.rate_hz

    def world(self) -> tuple[FloatArray, FloatArray]:
        """Return the positions (N, J, 3) in metres and the world_from_joint rotations (N, J, 4)."""
        return to_world(self.rig, self.root_positions_m, self.rotations)


def to_world(
    rig: Rig, root_positions_m: FloatArray, rotations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Compute forward kinematics of one pose, (3,) and (J, 4), or of many, (..., 3), (..., J, 4).

    Returns:
        Positions (..., J, 3) and world_from_joint rotations (..., J, 4).
    """
    positions = np.empty((*rotations.shape[:-1], 3))
    world = np.empty_like(rotations)
    positions[..., 0, :], world[..., 0, :] = root_positions_m, rotations[..., 0, :]
    for joint in range(1, rig.joint_count):
        parent = rig.parents[joint]
        outer = world[..., parent, :]
        world[..., joint, :] = multiply(outer, rotations[..., joint, :])
        positions[..., joint, :] = positions[..., parent, :] + rotate(outer, rig.offsets_m[joint])
    return positions, world


def to_local(rig: Rig, world: FloatArray) -> FloatArray:
    """Convert world_from_joint (..., J, 4) to parent_from_joint, the inverse of `to_world`."""
    local = world.copy()
    parents = list(rig.parents[1:])
    local[..., 1:, :] = multiply(conjugate(world[..., parents, :]), world[..., 1:, :])
    return normalise(local)
