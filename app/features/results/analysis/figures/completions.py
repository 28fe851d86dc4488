"""Figures of the number of completed tasks, by latency and by block."""

import pandas as pd

from app.features.results.analysis.figures.by_latency import (
    LATENCY,
    MEANS,
    Across,
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
from app.protocol import COUNTED_KINDS

KEY, TITLE = "completions", "Completed tasks by added latency"
LEARNING_KEY, LEARNING_TITLE = "learning", "Completed tasks over the blocks of a session"
BLOCK = Across("block", "block (1 = first)", "")
_ORDERS = (
    "In a balanced study every order of latencies is included, so a rise over blocks is "
    "practice and a fall is fatigue; with unbalanced orders, blocks are confounded with latency."
)
_UNIT = "tasks"


def completions_drawing(phases: pd.DataFrame) -> Drawing:
    """Draw completed tasks by latency, from valid rows of `phases`; no completions count as 0."""
    return _drawing(KEY, TITLE, MEANS, phases)


def learning_drawing(phases: pd.DataFrame) -> Drawing:
    """Draw completed tasks by the block of the session, from valid rows of `phases`."""
    words = MEANS.replace("each latency", "each block")
    return _drawing(LEARNING_KEY, LEARNING_TITLE, f"{words} {_ORDERS}", phases, BLOCK)


def _drawing(
    key: str, title: str, words: str, phases: pd.DataFrame, across: Across = LATENCY
) -> Drawing:
    # On the road nothing is completed with a limb.
    counted = phases["phase_kind"].isin(COUNTED_KINDS) & phases["limb"].notna()
    tasks = phases[counted].astype({"completions": "float64"})
    n = participants(tasks)
    if n < MIN_PARTICIPANTS:
        return too_few(key, title, words, n, "a finished hand or foot phase")
    values = per_participant(tasks.astype({across.column: "float64"}), "completions", across.column)
    figure = latency_figure(values, axis="completed tasks (per phase)", unit=_UNIT, across=across)
    figure.update_yaxes(rangemode="tozero")
    caption = f"{words} {count_note(n)} {limb_note(tasks)}"
    return drawn(key, title, caption, n, figure, drawn_rows(values, _UNIT, across))
