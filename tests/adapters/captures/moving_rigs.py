"""Random rigs and movements, with which writers are tested against readers."""

import numpy as np

from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, from_rotation_vector, identity, normalise

MOTIVE_BODY: tuple[tuple[str, int], ...] = (
    ("Hip", -1),
    ("Ab", 0),
    ("Chest", 1),
    ("Neck", 2),
    ("Head", 3),
    ("LShoulder", 2),
    ("LUArm", 5),
    ("LFArm", 6),
    ("LHand", 7),
    ("RShoulder", 2),
    ("RUArm", 9),
    ("RFArm", 10),
    ("RHand", 11),
    ("LThigh", 0),
    ("LShin", 13),
    ("LFoot", 14),
    ("LToe", 15),
    ("RThigh", 0),
    ("RShin", 17),
    ("RFoot", 18),
    ("RToe", 19),
)


def motive_body(*, fingers: bool = False) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return names and parents of Motive's skeleton of 21 bones, or of 51 with fingers."""
    bones = list(MOTIVE_BODY)
    if fingers:
        for side, hand in (("L", 8), ("R", 12)):
            for finger in ("Thumb", "Index", "Middle", "Ring", "Pinky"):
                for bone in (1, 2, 3):
                    bones.append((f"{side}{finger}{bone}", hand if bone == 1 else len(bones) - 1))
    return tuple(name for name, _ in bones), tuple(parent for _, parent in bones)


def random_rig(
    rng: np.random.Generator,
    names: tuple[str, ...],
    parents: tuple[int, ...],
    *,
    rest: bool = False,
    ends: bool = False,
) -> Rig:
    """Return a rig with bones of 5 to 40 cm, optionally with rest rotations and free ends."""
    count = len(names)
    directions = rng.normal(size=(count, 3))
    offsets = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    offsets *= rng.uniform(0.05, 0.4, (count, 1))
    offsets[0] = 0.0
    turns = normalise(rng.normal(size=(count, 4))) if rest else identity(count)
    leaves = [joint for joint in range(count) if joint not in parents]
    tips = tuple((joint, (0.1, -0.02 * joint, 0.03)) for joint in leaves) if ends else ()
    return Rig(names, parents, offsets, turns, tips)


def random_motion(
    rng: np.random.Generator, rig: Rig, *, frames: int = 40, rate_hz: float = 120.0
) -> RigMotion:
    """Return a movement in which every joint turns about a random pose and the root walks."""
    count, times = rig.joint_count, np.arange(frames) / rate_hz
    slow = np.sin(2.0 * np.pi * rng.uniform(0.3, 2.0, (count, 3)) * times[:, None, None])
    turns = from_rotation_vector(rng.uniform(-1.2, 1.2, (count, 3)) * (1.0 + slow))
    steps: FloatArray = np.stack((0.9 * times, 1.0 + 0.03 * slow[:, 0, 0], -0.4 * times), axis=-1)
    seen = np.ones((frames, count), dtype=np.bool_)
    return RigMotion(rig, rate_hz, steps, turns, seen)
