"""The box tasks, which a study defines for all participants: their places, colours and shapes.

Only the avatar is scaled. Shapes convey the same as colours to people who cannot distinguish those.

World frame: origin on the floor at the centre of the start square, +x right, +y up, the participant
faces -z; metres.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Length, Point, Strict, Text, refusal
from app.science.tasks import (
    BlockSpec,
    BoxSpec,
    Direction,
    Laterality,
    LayoutError,
    Limb,
    Side,
    TaskLayout,
    build_layout,
)

_MAX_BOXES = 12

Size = Annotated[tuple[Length, Length, Length], Field(description="[width, height, depth] in m")]
Colour = Annotated[
    str,
    StringConstraints(pattern=r"^#[0-9a-f]{6}$"),
    Field(description='"#rrggbb" in lower-case hexadecimal digits, in quotes'),
]
Cue = Literal["none", "check", "cross", "ring", "stripes"]


class SolidBlock(Strict):
    """A target or the start square: its centre and its size along x, y, z."""

    center_m: Point
    size_m: Size

    def spec(self) -> BlockSpec:
        """Return the block as used by the task geometry."""
        return BlockSpec(self.center_m, self.size_m)


class HandBox(Strict):
    """A box at chest height, open towards the participant; sizes are those of its cavity."""

    number: int
    center_m: Point
    inner_size_m: Size


class FootBox(Strict):
    """A box on the floor, open at the top. Its length (along z) is the same for all foot boxes."""

    number: int
    center_m: Point
    inner_width_m: Length
    inner_height_m: Length


class HandTask(Strict):
    """The hand task: touch each back panel, then the target; then in the reverse order.

    Touches with the writing hand count. `sides`: the walls (and "front_rim") that exist and turn
    red when touched. `direction`: the direction of the first order; "by_hand" lets it start at the
    side of the writing hand.
    """

    boxes: Annotated[tuple[HandBox, ...], Field(min_length=1, max_length=_MAX_BOXES)]
    target: SolidBlock
    wall_thickness_m: Length
    panel_thickness_m: Length
    sides: tuple[Side, ...]
    direction: Direction
    reverse_after_task: bool

    def layout(self) -> TaskLayout:
        """Return the surfaces of the task; raises LayoutError, but never for a loaded study."""
        boxes = tuple(BoxSpec(box.number, box.center_m, box.inner_size_m) for box in self.boxes)
        return build_layout(
            Limb.HAND,
            boxes,
            self.target.spec(),
            wall_thickness_m=self.wall_thickness_m,
            panel_thickness_m=self.panel_thickness_m,
            sides=self.sides,
            direction=self.direction,
            reverse_after_task=self.reverse_after_task,
        )

    @model_validator(mode="after")
    def _is_buildable(self) -> Self:
        _try(self)
        return self


class FootTask(Strict):
    """The foot task: step into each box, then onto the target bar.

    Then the participant walks back to the start square and continues. The boxes are `base_length_m`
    times `length_factor` long: the factor was added after expert feedback (Karas 2020, chapter
    7.2), and is separate so that both numbers stay visible.
    """

    boxes: Annotated[tuple[FootBox, ...], Field(min_length=1, max_length=_MAX_BOXES)]
    base_length_m: Length
    length_factor: Annotated[float, Field(gt=0, le=3)]
    target: SolidBlock
    start_square: SolidBlock
    wall_thickness_m: Length
    panel_thickness_m: Length
    sides: tuple[Side, ...]
    direction: Direction
    reverse_after_task: bool
    counting_foot: Literal["either", "left", "right"]

    @property
    def length_m(self) -> float:
        """The inner length of each box along z, metres."""
        return self.base_length_m * self.length_factor

    def layout(self) -> TaskLayout:
        """Return the surfaces of the task; raises LayoutError, but never for a loaded study."""
        boxes = tuple(
            BoxSpec(
                box.number, box.center_m, (box.inner_width_m, box.inner_height_m, self.length_m)
            )
            for box in self.boxes
        )
        either = self.counting_foot == "either"
        return build_layout(
            Limb.FOOT,
            boxes,
            self.target.spec(),
            start_square=self.start_square.spec(),
            wall_thickness_m=self.wall_thickness_m,
            panel_thickness_m=self.panel_thickness_m,
            sides=self.sides,
            direction=self.direction,
            reverse_after_task=self.reverse_after_task,
            counting_foot=None if either else Laterality(self.counting_foot),
        )

    @model_validator(mode="after")
    def _is_buildable(self) -> Self:
        _try(self)
        return self


class Tasks(Strict):
    """The tasks of each limb that the procedure uses, and optionally of the other limb."""

    # Left out of the content if not set, so that the hashes of other studies stay the same.
    hand: Annotated[HandTask | None, Field(exclude_if=lambda value: value is None)] = None
    foot: Annotated[FootTask | None, Field(exclude_if=lambda value: value is None)] = None

    def layouts(self) -> dict[Limb, TaskLayout]:
        """Return the surfaces of every task, the hand's first."""
        given = {Limb.HAND: self.hand, Limb.FOOT: self.foot}
        return {limb: task.layout() for limb, task in given.items() if task is not None}

    def layout(self, limb: str) -> TaskLayout:
        """Return the surfaces of the task of `limb`; raise KeyError if the study has none."""
        task = self.hand if limb == Limb.HAND else self.foot
        if task is None:
            raise KeyError(f"the study has no task for the {limb}")
        return task.layout()


def _try(task: HandTask | FootTask) -> None:
    try:
        task.layout()
    except LayoutError as error:
        raise refusal(
            f"The boxes cannot be built: {error}",
            valid="boxes numbered 1, 2, ... from the left, apart from each other and the target",
            remedy="Change the numbers, places or sizes of this task as the message says.",
        ) from error


class Colours(Strict):
    """The colour of each object of the task in each of its states."""

    panel: Colour
    panel_done: Colour
    side: Colour
    side_touched: Colour
    target: Colour
    start_square: Colour


class Cues(Strict):
    """The shape drawn on each object of the task in each of its states, besides its colour."""

    panel_done: Cue
    side_touched: Cue
    target: Cue


class Palette(Strict):
    """One set of colours and shapes for the task."""

    key: Key
    title: Text
    colours: Colours
    cues: Cues


class Appearance(Strict):
    """The palettes of a study; the operator may choose another than the default for a session."""

    default: Key
    palettes: Annotated[tuple[Palette, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _default_exists(self) -> Self:
        keys = [palette.key for palette in self.palettes]
        if self.default not in keys or len(set(keys)) < len(keys):
            raise refusal(
                "The default palette does not exist, or two palettes have the same key.",
                value=self.default,
                valid=keys,
                remedy="Give each palette its own key, and name one of them as the default.",
                at=("default",),
            )
        return self
