"""Export a movement as BVH text that all readers interpret in the same way.

BVH has no rest rotations: its rest pose consists of its offsets, along the world's axes. With W_j
the rest rotation of joint j in the world and Q_j(t) its rotation at time t,

    OFFSET_j = W_parent o_j,    world_from_joint in the file = Q_j(t) W_j^-1,

so every joint is in the same place at every time. The root's OFFSET is zero and its channels
contain its position, because readers disagree on whether the two are added.
"""

import numpy as np

from app.adapters.bvh import BvhClip, format_bvh
from app.science.rig import Rig, RigMotion, to_local
from app.science.rotations import FloatArray, conjugate, multiply, rotate

ROTATION_ORDER = "ZXY"
_TURNS = tuple(f"{axis}rotation" for axis in ROTATION_ORDER)
_PLACES = ("Xposition", "Yposition", "Zposition")


def to_bvh(motion: RigMotion, *, metres_per_unit: float = 0.01) -> str:
    """Format a movement as BVH, with Euler angles ZXY in degrees, y up.

    Spaces and braces in joint names, which many BVH readers cannot parse, become underscores.

    Args:
        motion: N frames of a rig.
        metres_per_unit: the file's unit; most programs expect centimetres.
    """
    rig = motion.rig
    _, at_rest = rig.rest_world()
    offsets = rig.offsets_m.copy()
    offsets[1:] = rotate(at_rest[list(rig.parents[1:])], rig.offsets_m[1:])
    offsets[0] = 0.0
    translations = np.broadcast_to(offsets, (motion.frame_count, *offsets.shape)).copy()
    translations[:, 0] = motion.root_positions_m
    _, world = motion.world()
    clip = BvhClip(
        names=safe_names(rig.names),
        parents=rig.parents,
        offsets_m=offsets,
        end_sites=_ends(rig, at_rest),
        channels=tuple(_TURNS if joint else (*_PLACES, *_TURNS) for joint in range(len(offsets))),
        frame_time_s=1.0 / motion.rate_hz,
        translations_m=translations,
        rotations=to_local(rig, multiply(world, conjugate(at_rest))),
    )
    return format_bvh(clip, metres_per_unit=metres_per_unit)


def safe_names(names: tuple[str, ...]) -> tuple[str, ...]:
    """Convert joint names to unique single words."""
    taken: set[str] = set()
    safe = []
    for name in names:
        word = "_".join(name.replace("{", " ").replace("}", " ").split()) or "joint"
        number, free = 2, word
        while free in taken:
            number, free = number + 1, f"{word}_{number}"
        taken.add(free)
        safe.append(free)
    return tuple(safe)


def _ends(rig: Rig, at_rest: FloatArray) -> tuple[tuple[int, tuple[float, float, float]], ...]:
    """Return end sites in world axes; each leaf joint has one, because readers need it."""
    ends = []
    for joint, offset in rig.ends:
        x, y, z = (float(value) for value in rotate(at_rest[joint], np.array(offset)))
        ends.append((joint, (x, y, z)))
    ended = {joint for joint, _ in ends} | set(rig.parents)
    ends += [(joint, (0.0, 0.0, 0.0)) for joint in range(len(rig.names)) if joint not in ended]
    return tuple(sorted(ends))
