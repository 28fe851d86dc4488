"""Skeletons for tests: the product's own body, and random bodies."""

import numpy as np

from app.science.rig import Rig, RigMotion
from app.science.rotations import (
    FloatArray,
    from_rotation_vector,
    identity,
    multiply,
    normalise,
    rotate,
)
from app.science.skeleton import JOINT_INDEX, JOINT_NAMES, PARENTS, build_skeleton

SAME = {name: name for name in JOINT_NAMES}
_FREE = ("Head", "LeftHand", "RightHand", "LeftToes", "RightToes")
_OUTWARDS = {"Arm": (-1.0, 0.0, 0.0), "Hand": (-1.0, 0.0, 0.0), "Leg": (0.0, -1.0, 0.0)}


def own_body(stature_m: float) -> Rig:
    """Return the product's skeleton in its T-pose, with ends of head, hands and toes."""
    skeleton = build_skeleton(stature_m)
    ends = []
    for name in _FREE:
        x, y, z = skeleton.ends_m[JOINT_INDEX[name]].tolist()
        ends.append((JOINT_INDEX[name], (x, y, z)))
    return Rig(JOINT_NAMES, PARENTS, skeleton.offsets_m, identity(len(JOINT_NAMES)), tuple(ends))


def scaled(rig: Rig, factor: float) -> Rig:
    """Return the same skeleton at another size."""
    ends = tuple((joint, (factor * x, factor * y, factor * z)) for joint, (x, y, z) in rig.ends)
    return Rig(rig.names, rig.parents, factor * rig.offsets_m, rig.rest_rotations, ends)


def random_body(rng: np.random.Generator, *, along_axes_share: float = 0.0) -> Rig:
    """Return a body with random bone lengths, directions, rest rotations and extra joints.

    Some of its bones lie exactly or almost along the axes they are aligned to, or against them,
    where rotations are nearly zero or nearly half a turn.
    """
    along_axes = rng.random() < along_axes_share
    names: list[str] = []
    parents: list[int] = []
    offsets: list[FloatArray] = []
    for name, parent in zip(JOINT_NAMES, PARENTS, strict=True):
        above = -1 if parent < 0 else names.index(JOINT_NAMES[parent])
        if above >= 0 and rng.random() < 0.2:
            names.append(f"between {name}")
            parents.append(above)
            offsets.append(0.3 * rng.uniform(size=3) * (not along_axes))
            above = len(names) - 1
        names.append(name)
        parents.append(above)
        offsets.append(_along_axis(name, rng) if along_axes else rng.normal(size=3))
    turns = rng.normal(size=(len(names), 4)) * (not along_axes) + (1e-9, 0.0, 0.0, 0.0)
    return Rig(tuple(names), tuple(parents), np.array(offsets), normalise(turns))


def _along_axis(name: str, rng: np.random.Generator) -> FloatArray:
    """Return a bone along its axis or against it, exact or off by a fraction of 1e-17 to 0.1."""
    if name.endswith(("UpperLeg", "UpperArm")):
        return np.array((-0.1 if name.startswith("Left") else 0.1, 0.0, 0.0))
    outwards = next((axis for part, axis in _OUTWARDS.items() if part in name), (0.0, 1.0, 0.0))
    sign = rng.choice((-1.0, 1.0))
    off = rng.choice((0.0, 1.0)) * 10.0 ** rng.uniform(-17, -1)
    return np.asarray(0.3 * (sign * np.array(outwards) + off * rng.normal(size=3)))


def random_movement(rig: Rig, rng: np.random.Generator, frames: int = 60) -> RigMotion:
    """Return a movement in which every joint turns smoothly and the root wanders upright."""
    times = np.arange(frames)[:, None, None] / 30.0
    joints = rig.joint_count
    swing = rng.normal(size=(joints, 3)) * np.sin(times + rng.uniform(0, 6, (joints, 1)))
    rotations = from_rotation_vector(0.5 * swing)
    root = np.cumsum(0.02 * rng.normal(size=(frames, 3)), axis=0)
    root[:, 1] += 0.9
    return RigMotion(rig, 120.0, root, rotations, np.ones((frames, joints), dtype=bool))


def turned(motion: RigMotion, turn: FloatArray) -> RigMotion:
    """Return the movement in a world turned by one rotation."""
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    root = rotate(turn, motion.root_positions_m)
    return RigMotion(motion.rig, motion.rate_hz, root, rotations, motion.observed)
