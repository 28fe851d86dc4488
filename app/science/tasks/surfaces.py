"""The objects of a task: boxes, target and start square as axis-aligned surfaces.

A task is a row of boxes and one target. Each box has a *panel* to touch and *sides* to avoid:

- hand boxes are in front of the participant and open towards them (+z); the grey panel closes the
  far end (-z);
- foot boxes are on the floor and open at the top; the panel is the floor plate.

World frame: +x right, +y up, the participant faces -z, the origin lies on the floor at the centre
of the start square; metres. Boxes are numbered by their positions, 1..n from left to right. The
number *displayed* at a box follows the current order (`views.displayed_numbers`).

The sizes and positions were chosen for Reembody: the thesis (Karas 2020, chapter 7) gives none.
"""

from dataclasses import dataclass
from functools import cached_property

from app.science.tasks.names import Direction, Laterality, Limb, Side, SurfaceKind

Vector3 = tuple[float, float, float]


class LayoutError(ValueError):
    """The configured boxes are not a valid layout; the message names the value and the remedy."""


@dataclass(frozen=True)
class BoxSpec:
    """One box: its position in the row and its cavity (the space inside the walls).

    `number`: the position, 1..n from left (-x) to right. `center_m`: centre of the cavity, world
    frame. `inner_size_m`: (width x, height y, depth z) of the cavity.
    """

    number: int
    center_m: Vector3
    inner_size_m: Vector3


@dataclass(frozen=True)
class BlockSpec:
    """A solid block: the hand target cube, the foot target bar or the start square. World frame."""

    center_m: Vector3
    size_m: Vector3


@dataclass(frozen=True)
class Surface:
    """One axis-aligned block that a body part can touch.

    `key`: "hand/2/panel", "hand/2/left", "hand/2/front_rim/top", "hand/target", "foot/start".
    `center_m`, `half_size_m`: world frame, metres. `box`: number of its box, None for target and
    start. `side`: set for kind SIDE only.
    """

    key: str
    kind: SurfaceKind
    box: int | None
    side: Side | None
    center_m: Vector3
    half_size_m: Vector3

    @property
    def unit(self) -> str:
        """The unit that turns red and is timed: the key, or "hand/2/front_rim" for rim bars."""
        return side_unit(self.key) or self.key


def side_unit(key: str) -> str | None:
    """Return the side of a surface, shared by its rim bars; None for a surface without a side."""
    words = key.split("/")
    return "/".join(words[:3]) if len(words) > 2 and words[2] != "panel" else None


@dataclass(frozen=True)
class TaskLayout:
    """The validated surfaces of a task; the same for every participant of a study version.

    `reverse_after_task`: whether the order is reversed after each completion. `counting_foot`: the
    foot that counts in a foot task, None for either. `direction`: the direction of the first order.
    """

    limb: Limb
    surfaces: tuple[Surface, ...]
    reverse_after_task: bool
    counting_foot: Laterality | None = None
    direction: Direction = Direction.BY_HAND

    @cached_property
    def by_key(self) -> dict[str, Surface]:
        """The surfaces of the layout, by key."""
        return {surface.key: surface for surface in self.surfaces}

    @cached_property
    def n_boxes(self) -> int:
        """Number of boxes (panels) in the row."""
        return sum(surface.kind is SurfaceKind.PANEL for surface in self.surfaces)

    @property
    def target_key(self) -> str:
        """Key of the target that completes a task."""
        return f"{self.limb}/target"

    @property
    def start_key(self) -> str | None:
        """Key of the start square; None if there is no walk back (hand tasks)."""
        key = f"{self.limb}/start"
        return key if key in self.by_key else None

    def panel_key(self, box: int) -> str:
        """Return the key of a box's panel."""
        return f"{self.limb}/{box}/panel"
