"""Colours of the task, and the shapes that say the same to people who cannot tell them apart."""

from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, Text, refusal

Colour = Annotated[
    str,
    StringConstraints(pattern=r"^#[0-9a-f]{6}$"),
    Field(description='"#rrggbb" in lower-case hexadecimal digits, in quotes'),
]
Cue = Literal["none", "check", "cross", "ring", "stripes"]


class Colours(Strict):
    """A colour for each thing of the task and each of its states."""

    panel: Colour
    panel_done: Colour
    side: Colour
    side_touched: Colour
    target: Colour
    start_square: Colour


class Cues(Strict):
    """A shape drawn on the thing in that state, besides its colour."""

    panel_done: Cue
    side_touched: Cue
    target: Cue


class Palette(Strict):
    """One way to show the task."""

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
                "The default palette is not there, or two palettes have one key.",
                value=self.default,
                valid=keys,
                remedy="Give each palette its own key, and name one of them as the default.",
                at=("default",),
            )
        return self
