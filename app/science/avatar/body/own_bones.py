"""Build the bones of a body whose joints are those of a humanoid model.

Masses are those of a person of the model's lengths (`proportions`), each in its part's own frame;
but joints lie where the model has them, and simple shapes reach from joint to joint. A part that
the model lacks is placed relative to the part above it as in a person.
"""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from app.science.avatar.body.figure import Figure
from app.science.avatar.body.parts import FINGER_PARTS, PARENT_OF, PART_NAMES
from app.science.avatar.body.proportions import Proportions
from app.science.rotations import Vector, v_add, v_length, v_scale, v_subtract

_SHORTEST_M = 1e-4
PERSON_SHAPED = ("Hand", "Foot", "Toes", "Head")
"""Parts that keep a person's simple shapes, boxes and a sphere, as no single bone defines them."""


def own_bones(bones: Proportions, figure: Figure) -> Proportions:
    """Return the bones with the joints of a model of the same stature."""
    places: dict[str, Vector] = {}
    joints: dict[str, Vector] = {}
    for part in PART_NAMES:
        above = PARENT_OF[part]
        usual = v_add(bones.joints_m[part], (0.0, 0.0, 0.0) if above is None else places[above])
        places[part] = figure.places_m.get(part, usual)
        joints[part] = places[part] if above is None else v_subtract(places[part], places[above])
    ends = dict(bones.ends_m)
    for part in PART_NAMES:
        above = PARENT_OF[part]
        if above is not None and _ends_at(part) and v_length(joints[part]) > _SHORTEST_M:
            ends[above] = joints[part]
        if part in FINGER_PARTS and part.endswith("Distal"):
            ends[part] = _straight_tip(joints[part], bones.ends_m[part])
    return replace(bones, joints_m=MappingProxyType(joints), ends_m=MappingProxyType(ends))


def sole_lift_m(part: str, bones: Proportions, places: Mapping[str, Vector]) -> Vector:
    """Return the vertical offset that puts the sole of a person's foot or toes on the floor.

    It is zero for all other parts.
    """
    if not part.endswith(("Foot", "Toes")):
        return (0.0, 0.0, 0.0)
    return (0.0, bones.places_m()[part][1] - places[part][1], 0.0)


def _ends_at(part: str) -> bool:
    """Return whether the bone of the part above ends at this part's joint."""
    if part.endswith(("Shoulder", "UpperLeg")):
        return False
    return "Middle" in part or not part.endswith("Proximal")


def _straight_tip(joint: Vector, end: Vector) -> Vector:
    """Return the tip of a finger, in the direction of the preceding bone."""
    length = v_length(joint)
    return v_scale(joint, v_length(end) / length) if length > _SHORTEST_M else end
