"""Figures of the embodiment scores, by latency and limb."""

from collections.abc import Iterator, Mapping

import pandas as pd

from app.features.results.analysis.figures.by_latency import (
    MEANS,
    drawn_rows,
    latency_figure,
    per_participant,
)
from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    limb_note,
    participants,
    too_few,
)

COMPONENTS: Mapping[str, tuple[str, str]] = {
    "ownership": ("Body ownership", "Ownership"),
    "agency": ("Agency", "Agency"),
    "location": ("Self-location", "Location"),
    "soe_thesis": ("Sense of embodiment (as in the thesis)", "Embodiment"),
}


def embodiment_drawings(scores: pd.DataFrame) -> Iterator[Drawing]:
    """Yield one drawing per embodiment component, from valid rows of the table of scores."""
    for score, (title, axis) in COMPONENTS.items():
        rows = scores[scores["score"] == score].dropna(subset=["limb", "value"])
        yield _component(score, title, axis, rows).of_group("embodiment")


def _component(score: str, title: str, axis: str, rows: pd.DataFrame) -> Drawing:
    key, title = f"embodiment_{score}", f"{title} by added latency"
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(key, title, MEANS, n, "a complete questionnaire")
    low, high = float(rows["minimum"].min()), float(rows["maximum"].max())
    bounded = pd.notna(low) and pd.notna(high)
    values = per_participant(rows, "value")
    figure = latency_figure(
        values,
        axis=f"{axis} (points)",
        unit="points",
        limits=(low, high) if bounded else None,
    )
    possible = f"Possible scores run from {low:g} to {high:g}." if bounded else ""
    caption = f"{MEANS} {count_note(n)} {possible} {limb_note(rows)}"
    drawing = drawn(key, title, caption, n, figure, drawn_rows(values, "points"))
    return drawing.tested_as(f"{rows['instrument'].iloc[0]}_{score}")
