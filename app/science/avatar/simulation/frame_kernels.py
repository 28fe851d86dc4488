"""Compiled functions that run once per frame, around the simulation's own steps.

Importing this module loads the compiler; a simulation imports it when it is created.
"""

import numpy as np

from app.science import rotations
from app.science.avatar.mjcf import IndexArray
from app.science.compiled import compiled, compiled_inside
from app.science.rotations import FloatArray, Quaternion, Vector

q_blend = compiled_inside(rotations.q_blend)


@compiled
def hips_way(
    start: tuple[Vector, Quaternion], end: tuple[Vector, Quaternion], steps: int
) -> FloatArray:
    """Return the poses (steps, 7), position and quaternion, on the straight way between two.

    The first is a step away from the start, the last is the end.
    """
    poses = np.empty((steps, 7))
    for row in range(steps):
        share = (row + 1) / steps
        for axis in range(3):
            poses[row, axis] = start[0][axis] + share * (end[0][axis] - start[0][axis])
        turn = q_blend(start[1], end[1], share) if row < steps - 1 else end[1]
        for part in range(4):
            poses[row, 3 + part] = turn[part]
    for axis in range(3):
        poses[steps - 1, axis] = end[0][axis]
    return poses


@compiled
def ramp(
    goal: FloatArray, ranges: FloatArray, command: FloatArray, slots: IndexArray,
    duration_s: float, fastest: float, controls: FloatArray,
) -> tuple[FloatArray, bool]:  # fmt: skip
    """Fill the controls (steps, nu) of a frame; return the last command and whether it was limited.

    The motors act from the beginning of a step to its end: their targets are those at its middle.
    """
    steps = controls.shape[0]
    last_command = np.empty_like(command)
    limited = False
    for row in range(slots.shape[0]):
        change = min(max(goal[row], ranges[row, 0]), ranges[row, 1]) - command[row]
        if abs(change) > fastest * duration_s:
            limited = True
            change = fastest * duration_s if change > 0.0 else -fastest * duration_s
        slot, speed = slots[row], change / duration_s
        for step in range(steps):
            controls[step, slot] = command[row] + change * ((step + 0.5) / steps)
            controls[step, slot + 1] = speed
        last_command[row] = command[row] + change
    return last_command, limited


@compiled
def local_rotations(world: FloatArray, parents: IndexArray, rows: IndexArray) -> FloatArray:
    """Return rotations parent^-1 row (n, 4) from bodies' world orientations (B, 4)."""
    rotations = np.empty((rows.shape[0], 4))
    for joint in range(rows.shape[0]):
        a, b = parents[joint], rows[joint]
        aw, ax, ay, az = world[a, 0], world[a, 1], world[a, 2], world[a, 3]
        bw, bx, by, bz = world[b, 0], world[b, 1], world[b, 2], world[b, 3]
        rotations[joint, 0] = aw * bw + ax * bx + ay * by + az * bz
        rotations[joint, 1] = aw * bx - ax * bw - ay * bz + az * by
        rotations[joint, 2] = aw * by + ax * bz - ay * bw - az * bx
        rotations[joint, 3] = aw * bz - ax * by + ay * bx - az * bw
    return rotations


@compiled
def pose(
    world: FloatArray, parents: IndexArray, rows: IndexArray,
    qpos: FloatArray, hinges: IndexArray, command: FloatArray, columns: IndexArray, axes: int,
) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Return local rotations (n, 4), and the angles and commands (axes,) of axes with a hinge.

    Other axes have NaN.
    """
    angles, commands = np.full(axes, np.nan), np.full(axes, np.nan)
    for row in range(columns.shape[0]):
        angles[columns[row]] = qpos[hinges[row]]
        commands[columns[row]] = command[row]
    return local_rotations(world, parents, rows), angles, commands
