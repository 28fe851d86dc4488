"""What a figure builder gives."""

import json
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import pandas as pd
import plotly.graph_objects as go

FEWEST_PARTICIPANTS = 1
"""One participant's own line is worth seeing; an interval needs two."""
Group = Literal["progress", "embodiment", "answers", "tasks", "movement", "quality"]


@dataclass(frozen=True)
class Drawing:
    """A figure with its words, or the sentence that stands in its place; `n` participants.

    `data`: the rows that were drawn, for a file. `wide`: it needs the width of the page.
    """

    key: str
    title: str
    caption: str
    n: int
    figure: go.Figure | None = None
    empty: str | None = None
    data: pd.DataFrame = field(default_factory=pd.DataFrame)
    group: Group = "tasks"
    wide: bool = False

    def as_json(self) -> dict[str, Any] | None:
        """The figure as plotly.js reads it."""
        if self.figure is None:
            return None
        loaded: dict[str, Any] = json.loads(self.figure.to_json())
        return loaded

    def among_chosen(self) -> "Drawing":
        """The same where only some sessions are looked at: others may have what is missing."""
        if self.empty is None:
            return self
        return replace(
            self, empty=f"Among what was chosen: {self.empty[0].lower()}{self.empty[1:]}"
        )

    def marked(self, prefix: str, note: str) -> "Drawing":
        """The same with words in front of the title, in the figure too, and behind the caption."""
        title = f"{prefix}{self.title}"
        if self.figure is not None:
            self.figure.update_layout(title_text=title)
        return replace(self, title=title, caption=f"{self.caption} {note}".strip())

    def of_group(self, group: Group, *, wide: bool = False) -> "Drawing":
        """The same in a group of the page."""
        return replace(self, group=group, wide=wide)


def drawn(
    key: str, title: str, caption: str, n: int, figure: go.Figure, data: pd.DataFrame
) -> Drawing:
    """A drawing with a figure, which gets the title too, and the rows that are in it."""
    figure.update_layout(title_text=title)
    return Drawing(key, title, " ".join(caption.split()), n, figure=figure, data=data)


def too_few(key: str, title: str, caption: str, n: int, what: str) -> Drawing:
    """A drawing without a figure: nobody has `what` yet."""
    empty = f"No participant has {what} yet."
    return Drawing(key, title, " ".join(caption.split()), n, empty=empty)


def count_note(n: int) -> str:
    """How many participants a figure shows; with one there is no interval."""
    if n == 1:
        return "n = 1 participant, so there is no interval yet."
    return f"n = {n} participants."


def participants(frame: pd.DataFrame) -> int:
    """How many participants have a row."""
    return int(frame["participant_code"].nunique())


def limb_note(phases: pd.DataFrame) -> str:
    """Whether limb and time can be told apart, from `phases` with limb and position."""
    placed = phases.dropna(subset=["limb", "position"])
    first = set(placed[placed["position"] == 1]["limb"])
    if len(first) != 1 or placed["limb"].nunique() < 2:
        return ""
    limb = first.pop()
    return f"The {limb} phase always came first in its block, so limb is confounded with time."
