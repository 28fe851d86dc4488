"""The figure of the rows that count in the analysis, of those left out, and of the reasons."""

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.drawing import Drawing, drawn, participants
from app.features.results.analysis.figures.theme import BLUE, ORANGE, hatched, new_figure
from app.protocol import COUNTED_KINDS

KEY, TITLE = "exclusions", "What counts and what is excluded"
WHAT = (
    "Everything stored of the sessions shown. A phase or form counts if it was finished, not "
    "repeated later, not skipped, and its session neither aborted nor withdrawn nor completed "
    "without what the study's rules require. A score is missing if one of its items has no "
    "answer."
)
_STYLES = {True: ("counts", BLUE, ""), False: ("left out", ORANGE, "/")}
LEFT_OUT = ("aborted", "withdrawn", "completed, not valid")
_ROW_PX = 34


def exclusions_drawing(
    sessions: pd.DataFrame, phases: pd.DataFrame, scores: pd.DataFrame
) -> Drawing:
    """Draw the counts from all rows, valid or not, of the three tables."""
    n = participants(sessions)
    if sessions.empty:
        empty = "No session has been created yet."
        return Drawing(KEY, TITLE, WHAT, 0, empty=empty, group="quality")
    rows = _counts(sessions, phases[phases["phase_kind"].isin(COUNTED_KINDS)], scores)
    figure = _figure(rows)
    caption = f"{WHAT} n = {n} participant{'s' if n != 1 else ''}."
    return drawn(KEY, TITLE, caption, n, figure, rows).of_group("quality")


def _figure(rows: pd.DataFrame) -> go.Figure:
    """Draw one panel each for sessions, phases and scores, because their counts differ widely."""
    kinds = list(dict.fromkeys(rows["what"]))
    figure = new_figure(
        rows=len(kinds), titles=tuple(kind.capitalize() for kind in kinds), vertical_spacing=0.16
    )
    for row, kind in enumerate(kinds, start=1):
        own = rows[rows["what"] == kind]
        for counts, (name, colour, pattern) in _STYLES.items():
            shown = own[own["counts"] == counts]
            bar = go.Bar(
                orientation="h",
                y=shown["reason"].tolist(),
                x=[int(count) for count in shown["count"]],
                text=[str(int(count)) for count in shown["count"]],
                textposition="outside",
                cliponaxis=False,
                name=name,
                legendgroup=name,
                showlegend=row == 1,
                marker=hatched(colour, pattern),
                hovertemplate=f"%{{y}}: %{{x}} ({name})<extra></extra>",
            )
            figure.add_trace(bar, row=row, col=1)
        figure.update_yaxes(autorange="reversed", row=row, col=1)
        # Leave room for the number to the right of the longest bar.
        longest = max(float(own["count"].max()), 1.0)
        figure.update_xaxes(range=[0.0, 1.15 * longest], row=row, col=1)
    figure.update_xaxes(title_text="count (sessions, phases, scores)", row=len(kinds), col=1)
    figure.update_layout(height=170 + _ROW_PX * len(rows))
    return figure


def _counts(sessions: pd.DataFrame, tasks: pd.DataFrame, scores: pd.DataFrame) -> pd.DataFrame:
    named = sessions["status"].mask(
        (sessions["status"] == "completed") & ~sessions["valid"], "completed, not valid"
    )
    found = [
        ("sessions", status, status not in LEFT_OUT, int(count))
        for status, count in named.value_counts().items()
    ]
    broken = ~tasks["valid"] & (tasks["status"] == "done")
    found += [
        ("phases", "count", True, int(tasks["valid"].sum())),
        ("phases", "repeated or skipped", False, int((tasks["status"] == "voided").sum())),
        ("phases", "session ended early or not valid", False, int(broken.sum())),
        ("phases", "not finished", False, int(_open(tasks))),
    ]
    of_phases = scores.dropna(subset=["limb"])
    missing = of_phases["valid"] & of_phases["value"].isna()
    found += [
        ("scores", "count", True, int((of_phases["valid"] & ~missing).sum())),
        ("scores", "an item has no answer", False, int(missing.sum())),
        (
            "scores",
            "repeated, skipped, ended early or not valid",
            False,
            int((~of_phases["valid"]).sum()),
        ),
    ]
    return pd.DataFrame(found, columns=["what", "reason", "counts", "count"])


def _open(tasks: pd.DataFrame) -> int:
    return int((~tasks["status"].isin(("done", "voided"))).sum())
