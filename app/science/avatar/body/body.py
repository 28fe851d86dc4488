"""The body of one avatar: which parts it has, where they hang, and what they are made of.

Every humanoid model is welcome: what it lacks is skipped. The parts that hung on a missing one hang
on the next part above it, at the same place; its shapes and its mass go there too. Only a part
without which there is no human body is required; the list is that of Unity's humanoid rigs.

A body may be that of a humanoid model (`figure`): then joints lie where the model has them, and
parts have a convex piece of its skin beside their simple shapes.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.science.avatar.body.figure import Figure
from app.science.avatar.body.hulls import Piece
from app.science.avatar.body.own_bones import LIKE_A_PERSONS, own_bones, sole_lift_m
from app.science.avatar.body.parts import FINGER_PARTS, PARENT_OF, PART_NAMES, SIDES
from app.science.avatar.body.proportions import BodyError, Proportions, proportions
from app.science.avatar.body.shapes import Shape, fingers_of, mitten, shapes_of
from app.science.rotations import Vector, v_add, v_subtract

__all__ = ["REQUIRED_PARTS", "Body", "BodyError", "BodyPart", "build_body"]

_REQUIRED_LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
REQUIRED_PARTS: tuple[str, ...] = (
    "Hips", "Spine", "Head", *(f"{side}{limb}" for side in SIDES for limb in _REQUIRED_LIMBS)
)  # fmt: skip
"""Parts without which a model is no humanoid."""


@dataclass(frozen=True)
class BodyPart:
    """One rigid part; its frame lies in its joint, parallel to the world in the T-pose.

    Attributes:
        name: HumanBodyBones name.
        parent: the part it hangs on; None for the hips.
        joint_m: its joint in the parent's frame; of the hips, their place above the floor.
        end_m: end of its bone in its own frame.
        shapes: what collides, in its own frame.
        piece: what may collide instead of them: the skin's convex piece in the same frame.
    """

    name: str
    parent: str | None
    joint_m: Vector
    end_m: Vector
    shapes: tuple[Shape, ...]
    piece: Piece | None = None


@dataclass(frozen=True)
class Body:
    """The parts an avatar has, a parent always before its children.

    Attributes:
        proportions: the bones of the complete body it was made from, whose masses it has.
        parts: the present parts by name, in the order of `PART_NAMES`.
        bones: the same with joints where they lie in this body: those of a model, if it is one's.
    """

    proportions: Proportions
    parts: Mapping[str, BodyPart]
    bones: Proportions

    @property
    def stature_m(self) -> float:
        """Body height."""
        return self.proportions.stature_m

    def stand_in(self, part: str) -> str:
        """The present part that carries this one: itself, or the next one above."""
        return _stand_in(part, self.parts)

    def places_m(self) -> dict[str, Vector]:
        """Where each present part's joint lies in the world in the T-pose."""
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
        segments_m: measured lengths by the names of `proportions.SEGMENT_NAMES`; they count for
            both sides.
        parts: HumanBodyBones names that the model has; names that are not among the 52 (eyes,
            jaw) are skipped.
        figure: the model whose body it is; parts that it lacks are left out. It has lengths of its
            own, so none are given.

    Raises:
        BodyError: a required part is missing, or a length is not plausible.
    """
    if figure is not None:
        if segments_m:
            raise BodyError(
                "A model has lengths of its own: give either a model or measured lengths."
            )
        figure = figure.scaled(stature_m)
        segments_m = figure.segments_m
        parts = [part for part in parts if part in figure.places_m]
    missing = [part for part in REQUIRED_PARTS if part not in parts]
    if missing:
        raise BodyError(
            f"The model has no {', '.join(missing)}, so it is no humanoid. A body needs"
            f" {', '.join(REQUIRED_PARTS)}: map these bones in the model's rig."
        )
    usual = proportions(stature_m, segments_m or {})
    bones = usual if figure is None else own_bones(usual, figure)
    present = [part for part in PART_NAMES if part in parts]
    shapes = _shapes(usual, bones, frozenset(present))
    places, pieces = bones.places_m(), {} if figure is None else figure.pieces
    built = {
        part: _part(part, bones, places, present, shapes[part], pieces.get(part))
        for part in present
    }
    return Body(usual, MappingProxyType(built), bones)


def _part(
    part: str,
    bones: Proportions,
    places: Mapping[str, Vector],
    present: Collection[str],
    shapes: tuple[Shape, ...],
    piece: Piece | None,
) -> BodyPart:
    above = PARENT_OF[part]
    end = bones.ends_m[part]
    if part.endswith("Hand") and not _has_fingers(part, present):
        x = bones.segments_m["hand"] * (-1.0 if part.startswith("Left") else 1.0)
        end = (x, 0.0, 0.0)
    if above is None:
        return BodyPart(part, None, places[part], end, shapes, piece)
    parent = _stand_in(above, present)
    joint = bones.joints_m[part] if parent == above else v_subtract(places[part], places[parent])
    return BodyPart(part, parent, joint, end, shapes, piece)


def _stand_in(part: str, present: Collection[str]) -> str:
    while part not in present:
        above = PARENT_OF[part]
        if above is None:
            raise BodyError(f"The body has no {part}.")
        part = above
    return part


def _has_fingers(hand: str, present: Collection[str]) -> bool:
    return any(part in present for finger in fingers_of(hand) for part in finger)


def _shapes(
    usual: Proportions, bones: Proportions, present: frozenset[str]
) -> dict[str, tuple[Shape, ...]]:
    places = bones.places_m()
    gathered: dict[str, list[Shape]] = {part: [] for part in present}
    for part in PART_NAMES:
        stand_in = _stand_in(part, present)
        if part in FINGER_PARTS and stand_in not in FINGER_PARTS:
            continue  # a finger the model does not have
        own = shapes_of(usual if part.endswith(LIKE_A_PERSONS) else bones, part)
        if part.endswith("Hand") and not _has_fingers(part, present):
            own = (mitten(usual, part),)
        by = v_subtract(places[part], places[stand_in])
        if bones is not usual:
            by = v_add(by, sole_lift_m(part, usual, places))
        moved = part != stand_in or bones is not usual
        gathered[stand_in] += [shape.moved(by) for shape in own] if moved else own
    return {part: tuple(shapes) for part, shapes in gathered.items()}
