"""What is done at every frame beside the simulation's own steps, compiled.

Importing this module loads the compiler; a simulation does so when it is made.
"""

import numpy as np

from app.science.avatar.mjcf import IndexArray
from app.science.compiled import compiled_fused
from app.science.rotations import FloatArray


@compiled_fused
def ramp(
    goal: FloatArray, ranges: FloatArray, command: FloatArray, slots: IndexArray,
    duration_s: float, fastest: float, controls: FloatArray,
) -> tuple[FloatArray, bool]:  # fmt: skip
    """Fill the controls (steps, nu) of a frame; return its last command and if it was too fast.

    A step's motors act from its beginning to its end: their targets are those of its middle.
    """
    steps = controls.shape[0]
    after = np.empty_like(command)
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
        after[row] = command[row] + change
    return after, limited


@compiled_fused
def local_rotations(world: FloatArray, parents: IndexArray, rows: IndexArray) -> FloatArray:
    """Rotations parent^-1 row (n, 4) of bodies' world orientations (B, 4)."""
    found = np.empty((rows.shape[0], 4))
    for joint in range(rows.shape[0]):
        a, b = parents[joint], rows[joint]
        aw, ax, ay, az = world[a, 0], world[a, 1], world[a, 2], world[a, 3]
        bw, bx, by, bz = world[b, 0], world[b, 1], world[b, 2], world[b, 3]
        found[joint, 0] = aw * bw + ax * bx + ay * by + az * bz
        found[joint, 1] = aw * bx - ax * bw - ay * bz + az * by
        found[joint, 2] = aw * by + ax * bz - ay * bw - az * bx
        found[joint, 3] = aw * bz - ax * by + ay * bx - az * bw
    return found
