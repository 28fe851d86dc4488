"""From a file's axes to ours: y up and right-handed.

A turn T of the axes carries places by T p and rotations by T q T^-1: world and bodies get new axes
alike, so a body that stood unturned in the file stands unturned here. A mirrored (left-handed)
world is Unity's: p' = (x, y, -z), q' = (w, -x, -y, z).
"""

from dataclasses import replace
from typing import Literal

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, Rig, RigMotion
from app.science.rotations import FloatArray, conjugate, multiply, rotate

Up = Literal["x", "y", "z"]
_HALF = float(np.sqrt(0.5))
# world_from_file: z up turns by -90 degrees about x, x up by +90 degrees about z.
_TURNS: dict[Up, tuple[float, float, float, float]] = {
    "x": (_HALF, 0.0, 0.0, _HALF),
    "y": (1.0, 0.0, 0.0, 0.0),
    "z": (_HALF, -_HALF, 0.0, 0.0),
}
_MIRRORED_PLACE: FloatArray = np.array((1.0, 1.0, -1.0))
_MIRRORED_TURN: FloatArray = np.array((1.0, -1.0, -1.0, 1.0))


def turned_places(places: FloatArray, up: Up) -> FloatArray:
    """Carry places or offsets (..., 3) from axes with this one up to y up."""
    return places if up == "y" else rotate(np.array(_TURNS[up]), places)


def turned_rotations(rotations: FloatArray, up: Up) -> FloatArray:
    """Carry rotations (..., 4), of the world or of a parent, from axes with this one up to y up."""
    if up == "y":
        return rotations
    turn = np.array(_TURNS[up])
    return multiply(multiply(turn, rotations), conjugate(turn))


def mirrored_places(places: FloatArray) -> FloatArray:
    """From Unity's left-handed world to the right-handed one, (..., 3)."""
    mirrored: FloatArray = places * _MIRRORED_PLACE
    return mirrored


def mirrored_rotations(rotations: FloatArray) -> FloatArray:
    """From Unity's left-handed world to the right-handed one, (..., 4) wxyz."""
    mirrored: FloatArray = rotations * _MIRRORED_TURN
    return mirrored


def turned_rig(rig: Rig, up: Up) -> Rig:
    """The same body with every frame's axes renamed so that y is up."""
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
    """The same movement with every frame's axes renamed so that y is up."""
    if up == "y":
        return motion
    return replace(
        motion,
        rig=turned_rig(motion.rig, up),
        root_positions_m=turned_places(motion.root_positions_m, up),
        rotations=turned_rotations(motion.rotations, up),
    )


def turned_markers(motion: MarkerMotion, up: Up) -> MarkerMotion:
    """The same markers in a world whose y is up."""
    return replace(motion, positions_m=turned_places(motion.positions_m, up))


def turned_bodies(motion: BodyMotion, up: Up) -> BodyMotion:
    """The same bodies in a world whose y is up."""
    return replace(
        motion,
        positions_m=turned_places(motion.positions_m, up),
        rotations=turned_rotations(motion.rotations, up),
    )


def _triple(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in vector)
    return (x, y, z)
