"""A humanoid model: the body parts it has, where their joints lie, and the skin that follows them.

In the T-pose, in the product's frame: x right, y up, facing -z, metres; the hips over the origin,
the soles at height zero. Bones and mesh of a file become one by `humanoid_pose`.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from app.science.rotations import FloatArray, Vector


class HumanoidError(ValueError):
    """A model is no humanoid body: a required part is missing, or its bones hang as no body's."""


@dataclass(frozen=True, eq=False)
class HumanoidPart:
    """One body part of a model.

    Attributes:
        place_m: its joint in the T-pose.
        vertices_m: (N, 3) the skin that follows it most, in the part's own frame: its joint, axes
            parallel to the world in the T-pose.
    """

    place_m: Vector
    vertices_m: FloatArray


@dataclass(frozen=True, eq=False)
class Humanoid:
    """A model in the T-pose.

    Attributes:
        stature_m: as its joints tell, whatever hair or hats it wears; see `humanoid_pose`.
        parts: HumanBodyBones name -> part, in the order of `PART_NAMES`.
        notes: what a reader should know, each a sentence.
    """

    stature_m: float
    parts: Mapping[str, HumanoidPart]
    notes: tuple[str, ...] = ()
