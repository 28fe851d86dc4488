"""Write the body and its configuration as one MuJoCo model.

`avatar_model` writes the MJCF of a configuration for a stature or a figure, with its scene; the
server and the browser load the same text. `hinge_table` finds the addresses of each axis in a
loaded model.
"""

from app.science.avatar.mjcf.gains import NATURAL_HZ, default_configuration
from app.science.avatar.mjcf.hinge_table import HingeTable, IndexArray, SimulationError, hinge_table
from app.science.avatar.mjcf.hinges import Hinge, hinges_of
from app.science.avatar.mjcf.mjcf import NO_TORQUE_NM, build_mjcf, driven_axes
from app.science.avatar.mjcf.model import AvatarModel, avatar_model
from app.science.avatar.mjcf.scene import FLOOR, FLOOR_ONLY, LooseBox, Scene, scene_of

__all__ = [
    "FLOOR",
    "FLOOR_ONLY",
    "NATURAL_HZ",
    "NO_TORQUE_NM",
    "AvatarModel",
    "Hinge",
    "HingeTable",
    "IndexArray",
    "LooseBox",
    "Scene",
    "SimulationError",
    "avatar_model",
    "build_mjcf",
    "default_configuration",
    "driven_axes",
    "hinge_table",
    "hinges_of",
    "scene_of",
]
