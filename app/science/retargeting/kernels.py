"""Retargeting compiled to machine code, for one frame or for all frames of a movement on one core.

Both use the same code, so that a movement is identical live and from a file. It works on blocks of
frames with the values of a component adjacent in memory, so that one instruction processes several
frames. Importing this module loads the compiler (half a second); `transfer` imports it when the
first retargeter is made.
"""

import numpy as np

from app.science.compiled import compiled_fused
from app.science.retargeting.plan import Body, IntArray
from app.science.rotations import FloatArray

BLOCK = 16
"""Frames per block: two bodies of 22 joints then fill half of a core's first-level cache."""


@compiled_fused
def transfer(
    roots: FloatArray,
    rotations: FloatArray,
    joints: IntArray,
    numbers: FloatArray,
    scratch: FloatArray,
    lift_m: float,
    roots_out: FloatArray,
    rotations_out: FloatArray,
) -> None:
    """Transfer N frames from a source to an avatar.

    Args:
        roots, rotations: (N, 3) and (N, S, 4) frames of the source.
        joints, numbers: the arrays of the `Plan`.
        scratch: (2, W, 4, BLOCK) working memory.
        lift_m: the hips are at scale * source + (0, lift_m, 0).
        roots_out, rotations_out: (N, 3) and (N, A, 4) resulting frames of the avatar.
    """
    source = Body(joints[0], numbers[0], _filled(joints[1]), _filled(joints[2]))
    avatar = Body(joints[3], numbers[1], _filled(joints[4]), _filled(joints[5]))
    moved_by, factors, scale = joints[6], numbers[2], numbers[3, 0, 0]
    source_world, avatar_world = scratch[0], scratch[1]
    for first in range(0, len(roots), BLOCK):
        n = min(BLOCK, len(roots) - first)
        _walk_source(rotations[first : first + n], source, source_world)
        _turn_avatar(source_world, avatar, moved_by, factors, avatar_world, n)
        _write_local(avatar_world, avatar, rotations_out[first : first + n])
        for b in range(n):
            x, y, z = roots[first + b, 0], roots[first + b, 1], roots[first + b, 2]
            dx, dy, dz = _root_to_hips(source, source_world, b)
            ax, ay, az = _root_to_hips(avatar, avatar_world, b)
            roots_out[first + b, 0] = scale * (x + dx) - ax
            roots_out[first + b, 1] = scale * (y + dy) - ay + lift_m
            roots_out[first + b, 2] = scale * (z + dz) - az


@compiled_fused
def _walk_source(rotations: FloatArray, source: Body, world: FloatArray) -> None:
    """Compute the source's world rotations for one block of frames.

    world_from_joint = world_from_parent parent_from_joint.
    """
    n = len(rotations)
    for joint in source.order:
        parent = source.parents[joint]
        if parent < 0:
            for b in range(n):
                for c in range(4):
                    world[joint, c, b] = rotations[b, joint, c]
            continue
        outer, inner = world[parent], world[joint]
        for b in range(n):
            aw, ax, ay, az = outer[0, b], outer[1, b], outer[2, b], outer[3, b]
            bw, bx = rotations[b, joint, 0], rotations[b, joint, 1]
            by, bz = rotations[b, joint, 2], rotations[b, joint, 3]
            inner[0, b] = aw * bw - ax * bx - ay * by - az * bz
            inner[1, b] = aw * bx + ax * bw + ay * bz - az * by
            inner[2, b] = aw * by - ax * bz + ay * bw + az * bx
            inner[3, b] = aw * bz + ax * by - ay * bx + az * bw


@compiled_fused
def _turn_avatar(
    source_world: FloatArray,
    avatar: Body,
    moved_by: IntArray,
    factors: FloatArray,
    world: FloatArray,
    n: int,
) -> None:
    """Compute the avatar's world rotations, normalised against rounding errors of the file."""
    for joint in avatar.order:
        fw, fx, fy, fz = factors[joint, 0], factors[joint, 1], factors[joint, 2], factors[joint, 3]
        inner = world[joint]
        mover, parent = moved_by[joint], avatar.parents[joint]
        if mover < 0 and parent < 0:
            inner[0, :n], inner[1, :n], inner[2, :n], inner[3, :n] = fw, fx, fy, fz
            continue
        outer = source_world[mover] if mover >= 0 else world[parent]
        for b in range(n):
            aw, ax, ay, az = outer[0, b], outer[1, b], outer[2, b], outer[3, b]
            w = aw * fw - ax * fx - ay * fy - az * fz
            x = aw * fx + ax * fw + ay * fz - az * fy
            y = aw * fy - ax * fz + ay * fw + az * fx
            z = aw * fz + ax * fy - ay * fx + az * fw
            shrink = 1.0 / np.sqrt(w * w + x * x + y * y + z * z)
            inner[0, b], inner[1, b] = w * shrink, x * shrink
            inner[2, b], inner[3, b] = y * shrink, z * shrink


@compiled_fused
def _write_local(world: FloatArray, avatar: Body, rotations_out: FloatArray) -> None:
    """Write the avatar's local rotations of one block of frames.

    parent_from_joint = world_from_parent^-1 world_from_joint.
    """
    n = len(rotations_out)
    for joint in avatar.order:
        parent, inner = avatar.parents[joint], world[joint]
        if parent < 0:
            for b in range(n):
                for c in range(4):
                    rotations_out[b, joint, c] = inner[c, b]
            continue
        outer = world[parent]
        for b in range(n):
            aw, ax, ay, az = outer[0, b], outer[1, b], outer[2, b], outer[3, b]
            bw, bx, by, bz = inner[0, b], inner[1, b], inner[2, b], inner[3, b]
            rotations_out[b, joint, 0] = aw * bw + ax * bx + ay * by + az * bz
            rotations_out[b, joint, 1] = aw * bx - ax * bw - ay * bz + az * by
            rotations_out[b, joint, 2] = aw * by + ax * bz - ay * bw - az * bx
            rotations_out[b, joint, 3] = aw * bz - ax * by + ay * bx - az * bw


@compiled_fused
def _root_to_hips(body: Body, world: FloatArray, b: int) -> tuple[float, float, float]:
    """Return the vector from the root to the hips, in the world."""
    sx, sy, sz = 0.0, 0.0, 0.0
    for joint in body.to_hips:
        outer = world[body.parents[joint]]
        w, x, y, z = outer[0, b], outer[1, b], outer[2, b], outer[3, b]
        vx, vy, vz = body.offsets_m[joint, 0], body.offsets_m[joint, 1], body.offsets_m[joint, 2]
        cx, cy, cz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
        sx += vx + w * cx + y * cz - z * cy
        sy += vy + w * cy + z * cx - x * cz
        sz += vz + w * cz + x * cy - y * cx
    return sx, sy, sz


@compiled_fused
def _filled(row: IntArray) -> IntArray:
    """Return the joints of a row without its padding."""
    count = 0
    while row[count] >= 0:
        count += 1
    return row[:count]


@compiled_fused
def transfer_frame(
    root: FloatArray,
    rotations: FloatArray,
    joints: IntArray,
    numbers: FloatArray,
    scratch: FloatArray,
    lift_m: float,
    root_out: FloatArray,
    rotations_out: FloatArray,
) -> None:
    """Transfer one frame, with root (3,) and rotations (S, 4); otherwise like `transfer`."""
    transfer(
        root.reshape((1, 3)),
        rotations.reshape((1, *rotations.shape)),
        joints,
        numbers,
        scratch,
        lift_m,
        root_out.reshape((1, 3)),
        rotations_out.reshape((1, *rotations_out.shape)),
    )
