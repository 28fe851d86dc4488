"""What a figure builder gives."""

import json
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd
import plotly.graph_objects as go

FEWEST_PARTICIPANTS = 2
"""A mean with an interval needs two people."""


@dataclass(frozen=True)
class Drawing:
    """A figure with its words, or the sentence that stands in its place; `n` participants."""

    key: str
    title: str
    caption: str
    n: int
    figure: go.Figure | None = None
    empty: str | None = None

    def as_json(self) -> dict[str, Any] | None:
        """The figure as plotly.js reads it."""
        if self.figure is None:
            return None
        loaded: dict[str, Any] = json.loads(self.figure.to_json())
        return loaded

    def marked(self, prefix: str, note: str) -> "Drawing":
        """The same with words in front of the title, in the figure too, and behind the caption."""
        title = f"{prefix}{self.title}"
        if self.figure is not None:
            self.figure.update_layout(title_text=title)
        return replace(self, title=title, caption=f"{self.caption} {note}".strip())


def drawn(key: str, title: str, caption: str, n: int, figure: go.Figure) -> Drawing:
    """A drawing with a figure, which gets the title too."""
    figure.update_layout(title_text=title)
    return Drawing(key, title, " ".join(caption.split()), n, figure=figure)


def too_few(key: str, title: str, caption: str, n: int, what: str) -> Drawing:
    """A drawing without a figure: how many participants have `what`, and how many it takes."""
    have = "No participant has" if n == 0 else f"{n} participant has"
    empty = f"{have} {what} yet; this figure needs at least {FEWEST_PARTICIPANTS}."
    return Drawing(key, title, " ".join(caption.split()), n, empty=empty)


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
