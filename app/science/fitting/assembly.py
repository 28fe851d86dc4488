"""Assemble a rig with bones of constant length, and its movement, from the joints of each frame.

Each joint's axes give its rotation in the world. The position of a joint in its parent's axes, as
the median over all frames, gives the direction of the bone between them, and the median distance
gives its length. In the rig's rest pose, the T-pose, every rotation is the identity.
"""

import numpy as np

from app.science.fitting.frames import in_frame
from app.science.fitting.model import Parts
from app.science.rig import Rig, RigMotion, to_local
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_NAMES, PARENTS

_POINT_M = 1e-6


def assemble(parts: Parts, rate_hz: float) -> tuple[RigMotion, float]:
    """Return the movement, and the rms distance of its joints from the measured centres in metres.

    Every part must be valid in every frame; the first one is the hips.
    """
    names = tuple(name for name in JOINT_NAMES if name in parts)
    parents = _parents(names)
    centres = np.stack([parts[name].centre_m for name in names], axis=1)
    axes = _axes(parts, names, parents)
    offsets = np.zeros((len(names), 3))
    for joint in range(1, len(names)):
        step = centres[:, joint] - centres[:, parents[joint]]
        offsets[joint] = _offset(in_frame(axes[:, parents[joint]], step))
    rotations = np.zeros((len(names), 4))
    rotations[:, 0] = 1.0
    rig = Rig(names, parents, offsets, rotations)
    world = _continuous(_quaternions(axes))
    motion = RigMotion(
        rig=rig,
        rate_hz=rate_hz,
        root_positions_m=centres[:, 0],
        rotations=to_local(rig, world),
        observed=np.stack([parts[name].seen for name in names], axis=1),
    )
    placed, _ = motion.world()
    residual = float(np.sqrt(np.mean(np.sum((placed - centres) ** 2, axis=-1))))
    return motion, residual


def _parents(names: tuple[str, ...]) -> tuple[int, ...]:
    """Return for each joint the index of its nearest ancestor that is present, -1 for the root."""
    out: list[int] = []
    for name in names:
        body = PARENTS[JOINT_NAMES.index(name)]
        while body >= 0 and JOINT_NAMES[body] not in names:
            body = PARENTS[body]
        out.append(names.index(JOINT_NAMES[body]) if body >= 0 else -1)
    return tuple(out)


def _axes(parts: Parts, names: tuple[str, ...], parents: tuple[int, ...]) -> FloatArray:
    out = np.empty((len(parts[names[0]].centre_m), len(names), 3, 3))
    for joint, name in enumerate(names):
        axes = parts[name].axes
        out[:, joint] = out[:, parents[joint]] if axes is None else axes
    return out


def _offset(local: FloatArray) -> FloatArray:
    """Return median direction times median length of bone vectors (N, 3) in the parent's axes."""
    length = float(np.median(np.linalg.norm(local, axis=-1)))
    middle: FloatArray = np.median(local, axis=0)
    size = float(np.linalg.norm(middle))
    if length < _POINT_M or size < _POINT_M:
        return np.zeros(3)
    return middle * (length / size)


def _quaternions(axes: FloatArray) -> FloatArray:
    from scipy.spatial.transform import Rotation  # slow to import, and only needed here

    flat = Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat(scalar_first=True)
    return np.asarray(flat, dtype=np.float64).reshape(*axes.shape[:-2], 4)


def _continuous(world: FloatArray) -> FloatArray:
    """Choose between q and -q the quaternion nearer to the previous frame's, (N, J, 4)."""
    away = np.einsum("nji,nji->nj", world[1:], world[:-1]) < 0.0
    flips = np.cumsum(away, axis=0) % 2 == 1
    out = world.copy()
    out[1:][flips] *= -1.0
    return out
