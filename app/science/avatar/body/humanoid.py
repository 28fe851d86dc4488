"""A humanoid model: its body parts, the positions of their joints, and their skin.

It is in the T-pose, in the world frame: x right, y up, facing -z, metres; the hips over the origin,
the soles at height zero. `humanoid_pose` makes it from the bones and the mesh of a file.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from app.science.rotations import FloatArray, Vector


class HumanoidError(ValueError):
    """A model is not a humanoid: a part is missing, or its bones do not form a human skeleton."""


@dataclass(frozen=True, eq=False)
class HumanoidPart:
    """One body part of a model.

    Attributes:
        place_m: position of its joint in the T-pose.
        vertices_m: (N, 3) the skin that follows this part most, in the part's own frame: origin in
            its joint, axes parallel to the world in the T-pose.
    """

    place_m: Vector
    vertices_m: FloatArray


@dataclass(frozen=True, eq=False)
class Humanoid:
    """A humanoid model in the T-pose.

    Attributes:
        stature_m: estimated from its joints, regardless of hair or hats; see `humanoid_pose`.
        parts: HumanBodyBones name -> part, in the order of `PART_NAMES`.
        notes: remarks for the user, each a sentence.
    """

    stature_m: float
    parts: Mapping[str, HumanoidPart]
    notes: tuple[str, ...] = ()
