"""Files of humanoid models: glTF 2.0 and VRM become `app.science.avatar.body.humanoid.Humanoid`."""

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.reader import Limits, ReadHumanoid, read_humanoid

__all__ = ["HumanoidFileError", "Limits", "ReadHumanoid", "read_humanoid"]
