"""The terms of the box tasks: limbs, sides, kinds of surface, and which body parts count."""

from enum import StrEnum


class Limb(StrEnum):
    """The limb with which a task is done; it is also the first word of every surface key."""

    HAND = "hand"
    FOOT = "foot"


class Laterality(StrEnum):
    """The participant's left (-x) or right (+x)."""

    LEFT = "left"
    RIGHT = "right"


class SurfaceKind(StrEnum):
    """The role of a surface in the task."""

    PANEL = "panel"
    SIDE = "side"
    TARGET = "target"
    START = "start"


class Side(StrEnum):
    """A wall of a box, as seen by the participant (who faces -z).

    Hand boxes have left, right, top, bottom and, where configured, a front rim: the edges around
    the opening. Foot boxes have left, right, front (nearer to the participant, +z) and back (-z).
    """

    LEFT = "left"
    RIGHT = "right"
    TOP = "top"
    BOTTOM = "bottom"
    FRONT_RIM = "front_rim"
    FRONT = "front"
    BACK = "back"


class Direction(StrEnum):
    """The direction of the first order: depending on the writing hand, or the same for everybody.

    `BY_HAND` means that right-handed people go from right to left, left-handed people from left to
    right (Karas 2020, appendix A.1).
    """

    BY_HAND = "by_hand"
    LEFT_TO_RIGHT = "left_to_right"
    RIGHT_TO_LEFT = "right_to_left"


_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
_PHALANGES = ("Proximal", "Intermediate", "Distal")


def hand_parts(hand: Laterality) -> frozenset[str]:
    """Return the hand and its 15 finger bones by their Unity HumanBodyBones names (16 names)."""
    prefix = hand.value.capitalize()
    fingers = {f"{prefix}{finger}{phalanx}" for finger in _FINGERS for phalanx in _PHALANGES}
    return frozenset(fingers | {f"{prefix}Hand"})


def foot_parts(foot: Laterality | None) -> frozenset[str]:
    """Return the names of foot and toes of one foot, or of both feet for None."""
    feet = (Laterality.LEFT, Laterality.RIGHT) if foot is None else (foot,)
    return frozenset(f"{f.value.capitalize()}{part}" for f in feet for part in ("Foot", "Toes"))
