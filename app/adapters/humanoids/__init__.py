"""Read humanoid models from glTF 2.0 and VRM files, and write figures of our own.

What is read becomes `app.science.avatar.body.Humanoid`. `writer` is imported by itself, because
only the command that makes figures needs it.
"""

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.contents import Contents, Texture
from app.adapters.humanoids.reader import (
    Limits,
    ReadHumanoid,
    ReadSkin,
    read_humanoid,
    read_skin,
)
from app.adapters.humanoids.rights import ModelRights, Permission, Wearers

__all__ = [
    "Contents",
    "HumanoidFileError",
    "Limits",
    "ModelRights",
    "Permission",
    "ReadHumanoid",
    "ReadSkin",
    "Texture",
    "Wearers",
    "read_humanoid",
    "read_skin",
]
