"""With which shape each body part touches things.

A part has its simple shapes (capsules and boxes) and, where a humanoid model gives it a skin, a
convex piece of that. Both can be in one model, of which one touches; so it can be changed while
the avatar runs (`switches.use_collider`). A part without a piece keeps its simple shapes.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

ColliderKind = Literal["simple", "mesh", "none"]


@dataclass(frozen=True)
class Colliders:
    """What the parts of one model collide with.

    Attributes:
        kinds: body part -> kind; `simple` for those that are not named.
        both: whether convex pieces are in the model beside the simple shapes.
    """

    kinds: Mapping[str, ColliderKind] = field(default_factory=dict)
    both: bool = False

    def of(self, part: str) -> ColliderKind:
        """The kind of a part."""
        return self.kinds.get(part, "simple")


SIMPLE: Final = Colliders()
"""Capsules and boxes for every part."""
