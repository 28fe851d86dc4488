"""The result of a figure builder, and helpers that make one."""

import json
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import pandas as pd
import plotly.graph_objects as go

MIN_PARTICIPANTS = 1
"""Even one participant's line is drawn; an interval needs two participants."""
Group = Literal["progress", "embodiment", "answers", "tasks", "movement", "demographics", "quality"]


@dataclass(frozen=True)
class Drawing:
    """A figure with its texts; without a figure, `empty` is a sentence that says what is missing.

    `n`: number of participants. `data`: the rows that were drawn, for a file. `wide`: the figure
    needs the full width of the page. `every_body`: it has all bodies, even if one was chosen.
    `measure`: the measure of the statistics page that has the tests of what is drawn.
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
    every_body: bool = False
    measure: str = ""

    def as_json(self) -> dict[str, Any] | None:
        """Return the figure in the form that plotly.js reads, or None if there is no figure."""
        if self.figure is None:
            return None
        loaded: dict[str, Any] = json.loads(self.figure.to_json())
        return loaded

    def among_chosen(self) -> "Drawing":
        """Return a copy whose empty text says that only the filtered sessions were considered."""
        if self.empty is None:
            return self
        return replace(self, empty=f"For this selection: {self.empty[0].lower()}{self.empty[1:]}")

    def marked(self, prefix: str, note: str) -> "Drawing":
        """Return a copy with `prefix` before the title and `note` after the caption.

        The title in the figure itself is changed, too.
        """
        title = f"{prefix}{self.title}"
        if self.figure is not None:
            self.figure.update_layout(title_text=title)
        return replace(self, title=title, caption=f"{self.caption} {note}".strip())

    def tested_as(self, measure: str) -> "Drawing":
        """Return a copy that leads to the tests of this measure on the statistics page."""
        return replace(self, measure=measure)

    def of_group(self, group: Group, *, wide: bool = False) -> "Drawing":
        """Return a copy that belongs to a group of figures on the page."""
        return replace(self, group=group, wide=wide)


def drawn(
    key: str, title: str, caption: str, n: int, figure: go.Figure, data: pd.DataFrame
) -> Drawing:
    """Return a drawing with a figure, to which the title is added, and the rows in it."""
    figure.update_layout(title_text=title)
    return Drawing(key, title, " ".join(caption.split()), n, figure=figure, data=data)


def too_few(key: str, title: str, caption: str, n: int, what: str) -> Drawing:
    """Return a drawing without a figure that says that no participant has `what` yet."""
    empty = f"No participant has {what} yet."
    return Drawing(key, title, " ".join(caption.split()), n, empty=empty)


def count_note(n: int) -> str:
    """Return a sentence with the number of participants; one participant has no interval."""
    if n == 1:
        return "n = 1 participant, so there is no confidence interval yet."
    return f"n = {n} participants."


def participants(frame: pd.DataFrame) -> int:
    """Return the number of participants that have a row."""
    return int(frame["participant_code"].nunique())


def limb_note(phases: pd.DataFrame) -> str:
    """Return a sentence if limb is confounded with time, from `phases` with limb and position."""
    placed = phases.dropna(subset=["limb", "position"])
    first = set(placed[placed["position"] == 1]["limb"])
    if len(first) != 1 or placed["limb"].nunique() < 2:
        return ""
    limb = first.pop()
    return f"The {limb} phase always came first in its block, so limb is confounded with time."
