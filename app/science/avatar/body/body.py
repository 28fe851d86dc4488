"""Build the body of one avatar: which parts it has, how they are connected, and their shapes.

A humanoid model may lack parts. The children of a missing part are attached to the nearest present
part above it, without changing their position; its shapes and its mass go there too. Only the parts
without which there is no human body are required; the list is that of Unity's humanoid rigs.

A body may be that of a humanoid model (`figure`): then joints lie where the model has them, and
each part has a convex piece of its skin in addition to its simple shapes.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.science.avatar.body.figure import Figure
from app.science.avatar.body.hulls import Piece
from app.science.avatar.body.own_bones import PERSON_SHAPED, own_bones, sole_lift_m
from app.science.avatar.body.parts import FINGER_PARTS, PARENT_OF, PART_NAMES, SIDES
from app.science.avatar.body.proportions import BodyError, Proportions, proportions
from app.science.avatar.body.shapes import Shape, fingers_of, mitten, shapes_of
from app.science.rotations import Vector, v_add, v_subtract

__all__ = ["REQUIRED_PARTS", "Body", "BodyError", "BodyPart", "build_body"]

_REQUIRED_LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
REQUIRED_PARTS: tuple[str, ...] = (
    "Hips", "Spine", "Head", *(f"{side}{limb}" for side in SIDES for limb in _REQUIRED_LIMBS)
)  # fmt: skip
"""Parts that a model needs to be a humanoid."""


@dataclass(frozen=True)
class BodyPart:
    """One rigid part of a body, with its connection to its parent, its bone and its shapes.

    Its frame has its origin in its joint and is parallel to the world in the T-pose.

    Attributes:
        name: HumanBodyBones name.
        parent: the part it is attached to; None for the hips.
        joint_m: its joint in the parent's frame; for the hips, their position above the floor.
        end_m: end of its bone in its own frame.
        shapes: its collision shapes, in its own frame.
        piece: convex piece of the skin in the same frame, which may collide instead of the shapes.
    """

    name: str
    parent: str | None
    joint_m: Vector
    end_m: Vector
    shapes: tuple[Shape, ...]
    piece: Piece | None = None


@dataclass(frozen=True)
class Body:
    """The parts of an avatar, each parent before its children.

    Attributes:
        proportions: bones of the complete body of a person of the same lengths, which determine the
            masses.
        parts: the present parts by name, in the order of `PART_NAMES`.
        bones: bones with the joints of this body: for a model's body, where the model has them;
            otherwise the same as `proportions`.
    """

    proportions: Proportions
    parts: Mapping[str, BodyPart]
    bones: Proportions

    @property
    def stature_m(self) -> float:
        """Return the body height."""
        return self.proportions.stature_m

    def carrier_of(self, part: str) -> str:
        """Return the part itself if the body has it, else the nearest present part above it."""
        return _carrier_of(part, self.parts)

    def places_m(self) -> dict[str, Vector]:
        """Return the position of each present part's joint in the world in the T-pose."""
        places = self.bones.places_m()
        return {part: places[part] for part in self.parts}


def build_body(
    stature_m: float,
    *,
    segments_m: Mapping[str, float] | None = None,
    parts: Collection[str] = PART_NAMES,
    figure: Figure | None = None,
) -> Body:
    """Build the body of a person of this stature.

    Args:
        stature_m: 0.5 to 2.6 m.
        segments_m: measured lengths by the names of `proportions.SEGMENT_NAMES`; they apply to both
            sides.
        parts: HumanBodyBones names that the model has; names that are not among the 52 (eyes, jaw)
            are skipped.
        figure: the model whose body it is; parts that it lacks are left out. It has lengths of its
            own, so `segments_m` must not be given.

    Raises:
        BodyError: a required part is missing, or a length is not plausible.
    """
    if figure is not None:
        if segments_m:
            raise BodyError(
                "A model has its own lengths: give either a model or measured lengths, not both."
            )
        figure = figure.scaled(stature_m)
        segments_m = figure.segments_m
        parts = [part for part in parts if part in figure.places_m]
    missing = [part for part in REQUIRED_PARTS if part not in parts]
    if missing:
        raise BodyError(
            f"The model has no {', '.join(missing)}, so it is not a humanoid. A body needs"
            f" {', '.join(REQUIRED_PARTS)}: map these bones in the model's rig."
        )
    expected = proportions(stature_m, segments_m or {})
    bones = expected if figure is None else own_bones(expected, figure)
    present = [part for part in PART_NAMES if part in parts]
    shapes = _shapes(expected, bones, frozenset(present))
    places, pieces = bones.places_m(), {} if figure is None else figure.pieces
    built = {
        part: _part(part, bones, places, present, shapes[part], pieces.get(part))
        for part in present
    }
    return Body(expected, MappingProxyType(built), bones)


def _part(
    part: str,
    bones: Proportions,
    places: Mapping[str, Vector],
    present: Collection[str],
    shapes: tuple[Shape, ...],
    piece: Piece | None,
) -> BodyPart:
    usual_parent = PARENT_OF[part]
    end = bones.ends_m[part]
    if part.endswith("Hand") and not _has_fingers(part, present):
        x = bones.segments_m["hand"] * (-1.0 if part.startswith("Left") else 1.0)
        end = (x, 0.0, 0.0)
    if usual_parent is None:
        return BodyPart(part, None, places[part], end, shapes, piece)
    parent = _carrier_of(usual_parent, present)
    is_usual = parent == usual_parent
    joint = bones.joints_m[part] if is_usual else v_subtract(places[part], places[parent])
    return BodyPart(part, parent, joint, end, shapes, piece)


def _carrier_of(part: str, present: Collection[str]) -> str:
    while part not in present:
        parent = PARENT_OF[part]
        if parent is None:
            raise BodyError(f"The body has no {part}.")
        part = parent
    return part


def _has_fingers(hand: str, present: Collection[str]) -> bool:
    return any(part in present for finger in fingers_of(hand) for part in finger)


def _shapes(
    expected: Proportions, bones: Proportions, present: frozenset[str]
) -> dict[str, tuple[Shape, ...]]:
    places = bones.places_m()
    shapes_by_part: dict[str, list[Shape]] = {part: [] for part in present}
    for part in PART_NAMES:
        carrier = _carrier_of(part, present)
        if part in FINGER_PARTS and carrier not in FINGER_PARTS:
            continue  # a finger that the model lacks
        own = shapes_of(expected if part.endswith(PERSON_SHAPED) else bones, part)
        if part.endswith("Hand") and not _has_fingers(part, present):
            own = (mitten(expected, part),)
        offset = v_subtract(places[part], places[carrier])
        if bones is not expected:
            offset = v_add(offset, sole_lift_m(part, expected, places))
        is_moved = part != carrier or bones is not expected
        shapes_by_part[carrier] += [shape.moved(offset) for shape in own] if is_moved else own
    return {part: tuple(shapes) for part, shapes in shapes_by_part.items()}
