"""Read humanoid models from glTF 2.0 and VRM files.

They become `app.science.avatar.body.Humanoid`.
"""

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.reader import (
    Limits,
    ReadHumanoid,
    ReadSkin,
    read_humanoid,
    read_skin,
)

__all__ = ["HumanoidFileError", "Limits", "ReadHumanoid", "ReadSkin", "read_humanoid", "read_skin"]
