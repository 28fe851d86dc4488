"""How many tasks were completed, at each latency and with each limb."""

import pandas as pd

from app.features.analysis.figures.by_latency import MEANS, latency_figure, per_participant
from app.features.analysis.figures.drawing import (
    FEWEST_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    limb_note,
    participants,
    too_few,
)

KEY, TITLE = "completions", "Completed tasks by added latency"


def completions_drawing(phases: pd.DataFrame) -> Drawing:
    """From valid rows of the table of phases; a phase without a completion counts as 0."""
    tasks = phases[phases["phase_kind"] == "task"].astype({"completions": "float64"})
    n = participants(tasks)
    if n < FEWEST_PARTICIPANTS:
        return too_few(KEY, TITLE, MEANS, n, "a finished hand or foot phase")
    figure = latency_figure(
        per_participant(tasks, "completions"), axis="completed tasks (per phase)", unit="tasks"
    )
    figure.update_yaxes(rangemode="tozero")
    return drawn(KEY, TITLE, f"{MEANS} {count_note(n)} {limb_note(tasks)}", n, figure)
