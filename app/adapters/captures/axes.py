"""Convert a file's axes to ours: y up and right-handed.

A rotation T of the axes maps positions to T p and rotations to T q T^-1: the world and the bodies
get new axes together, so a body that is unrotated in the file is unrotated here. A mirrored
(left-handed) world is Unity's: p' = (x, y, -z), q' = (w, -x, -y, z).
"""

from dataclasses import replace
from typing import Literal

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, Rig, RigMotion
from app.science.rotations import FloatArray, conjugate, multiply, rotate

Up = Literal["x", "y", "z"]
_HALF = float(np.sqrt(0.5))
# world_from_file: z up is rotated by -90 degrees about x, x up by +90 degrees about z.
_TURNS: dict[Up, tuple[float, float, float, float]] = {
    "x": (_HALF, 0.0, 0.0, _HALF),
    "y": (1.0, 0.0, 0.0, 0.0),
    "z": (_HALF, -_HALF, 0.0, 0.0),
}
_MIRRORED_PLACE: FloatArray = np.array((1.0, 1.0, -1.0))
_MIRRORED_TURN: FloatArray = np.array((1.0, -1.0, -1.0, 1.0))


def turned_places(places: FloatArray, up: Up) -> FloatArray:
    """Convert positions or offsets (..., 3) from axes with `up` upward to y up."""
    return places if up == "y" else rotate(np.array(_TURNS[up]), places)


def turned_rotations(rotations: FloatArray, up: Up) -> FloatArray:
    """Convert world or local rotations (..., 4) from axes with `up` upward to y up."""
    if up == "y":
        return rotations
    turn = np.array(_TURNS[up])
    return multiply(multiply(turn, rotations), conjugate(turn))


def mirrored_places(places: FloatArray) -> FloatArray:
    """Convert positions (..., 3) from Unity's left-handed world to the right-handed one."""
    mirrored: FloatArray = places * _MIRRORED_PLACE
    return mirrored


def mirrored_rotations(rotations: FloatArray) -> FloatArray:
    """Convert rotations (..., 4) wxyz from Unity's left-handed world to the right-handed one."""
    mirrored: FloatArray = rotations * _MIRRORED_TURN
    return mirrored


def turned_rig(rig: Rig, up: Up) -> Rig:
    """Return the same rig with the axes of every frame renamed so that y is up."""
    ends = tuple(
        (joint, _triple(turned_places(np.array(offset), up))) for joint, offset in rig.ends
    )
    return replace(
        rig,
        offsets_m=turned_places(rig.offsets_m, up),
        rest_rotations=turned_rotations(rig.rest_rotations, up),
        ends=ends,
    )


def turned_rig_motion(motion: RigMotion, up: Up) -> RigMotion:
    """Return the same movement with the axes of every frame renamed so that y is up."""
    if up == "y":
        return motion
    return replace(
        motion,
        rig=turned_rig(motion.rig, up),
        root_positions_m=turned_places(motion.root_positions_m, up),
        rotations=turned_rotations(motion.rotations, up),
    )


def turned_markers(motion: MarkerMotion, up: Up) -> MarkerMotion:
    """Return the same markers in a world whose y axis is up."""
    return replace(motion, positions_m=turned_places(motion.positions_m, up))


def turned_bodies(motion: BodyMotion, up: Up) -> BodyMotion:
    """Return the same bodies in a world whose y axis is up."""
    return replace(
        motion,
        positions_m=turned_places(motion.positions_m, up),
        rotations=turned_rotations(motion.rotations, up),
    )


def _triple(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in vector)
    return (x, y, z)
