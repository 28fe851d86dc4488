"""Figures of recording quality: frame rates, gaps and alarms."""

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.drawing import (
    Drawing,
    count_note,
    drawn,
    participants,
    too_few,
)
from app.features.results.analysis.figures.theme import (
    BLUE,
    CALM,
    ORANGE,
    PATTERNS,
    VERMILLION,
    hatched,
    new_figure,
)

KEY, TITLE = "quality", "Quality of the recorded movement"
WHAT = (
    "One point per phase and stream (target: the tracked pose; actual: the body that was "
    "seen). The box contains the middle half, its line is the median. A gap is a time of more than "
    "2.5 usual frame intervals and 40 ms without a frame."
)
ALARMS_KEY, ALARMS_TITLE = "alarms", "Alarms during sessions"
ALARMS_WHAT = "Number of times each alarm was raised, over all sessions shown."
_STYLES = {"target": (BLUE, "circle"), "actual": (VERMILLION, "square")}
_SEVERITIES = {
    "critical": (VERMILLION, PATTERNS[2]),
    "warning": (ORANGE, PATTERNS[1]),
    "info": (BLUE, ""),
}
_MAX_POINTS = 400
_ROW_PX = 34


def quality_drawing(quality: pd.DataFrame) -> Drawing:
    """Draw frame rates and gaps per stream, from valid rows of the table of quality."""
    n = participants(quality)
    if n == 0:
        return too_few(KEY, TITLE, WHAT, 0, "a phase with movement").of_group("quality")
    rows = quality.assign(
        gap_percent=100.0 * quality["gap_s"] / quality["span_s"].where(quality["span_s"] > 0.0)
    )
    panels = (("frame_rate_hz", "frame rate (Hz)"), ("gap_percent", "time in gaps (%)"))
    figure = new_figure(titles=("Frame rate", "Gaps"), horizontal_spacing=0.14)
    for column, (name, axis) in enumerate(panels, start=1):
        for stream, (colour, symbol) in _STYLES.items():
            own = rows[rows["stream"] == stream].dropna(subset=[name])
            figure.add_trace(_box(own, name, stream, (colour, symbol)), row=1, col=column)
        figure.update_yaxes(title_text=axis, rangemode="tozero", row=1, col=column)
        figure.update_xaxes(title_text="stream", row=1, col=column)
    figure.update_layout(showlegend=False, margin={"b": 60})
    broken = int(rows[["jumps", "non_unit", "non_finite", "backwards"]].sum().sum())
    caption = (
        f"{WHAT} {len(rows)} streams of phases; {int(rows['gaps'].sum())} gaps, {broken} frames "
        f"that jump, go back in time or have no valid rotation. {count_note(n)}"
    )
    names = ["participant_code", "session_id", "phase_id", "limb", "latency_ms", "stream"]
    figures = ["frame_rate_hz", "gap_percent", "gaps", "gap_s", "longest_gap_s", "jumps"]
    data = rows[[*names, *figures, "frozen_s", "non_unit", "non_finite", "backwards"]]
    return drawn(KEY, TITLE, caption, n, figure, data).of_group("quality")


def _box(own: pd.DataFrame, name: str, stream: str, style: tuple[str, str]) -> go.Box:
    colour, symbol = style
    return go.Box(
        # dtype=object: plotly would inspect every item of a list, and encode numbers in binary.
        x=np.full(len(own), stream, dtype=object),
        y=own[name].astype("float64").to_numpy(dtype=object),
        name=stream,
        boxpoints="all" if len(own) <= _MAX_POINTS else "outliers",
        jitter=0.6,
        pointpos=0,
        fillcolor=CALM,
        line={"color": colour, "width": 2},
        marker={"color": colour, "symbol": symbol, "size": 4},
        text=own["participant_code"].to_numpy(dtype=object),
        hovertemplate=f"%{{text}}: %{{y:.2f}}<extra>{stream}</extra>",
    )


def alarms_drawing(alarms: pd.DataFrame, sessions: int) -> Drawing:
    """Draw how often each alarm was raised, from the table of alarms of `sessions` sessions."""
    raised = alarms[alarms["state"] == "raised"]
    n = participants(raised)
    what = f"{ALARMS_WHAT} {sessions} session{'s' if sessions != 1 else ''}."
    if raised.empty:
        empty = "No alarm was raised." if sessions else "No session has been created yet."
        return Drawing(ALARMS_KEY, ALARMS_TITLE, what, n, empty=empty, group="quality")
    counts = raised.groupby(["code", "severity"]).size().rename("count").reset_index()
    order = counts.groupby("code")["count"].sum().sort_values(ascending=False).index.tolist()
    figure = new_figure()
    for severity, (colour, pattern) in _SEVERITIES.items():
        own = counts[counts["severity"] == severity].set_index("code")["count"]
        if len(own):
            figure.add_trace(
                go.Bar(
                    orientation="h",
                    y=[code.replace("_", " ") for code in order],
                    x=[int(own.get(code, 0)) or None for code in order],
                    name=severity,
                    marker=hatched(colour, pattern),
                    hovertemplate=f"%{{y}}: %{{x}} x {severity}<extra></extra>",
                )
            )
    figure.update_layout(barmode="stack", height=150 + _ROW_PX * max(len(order), 3))
    figure.update_xaxes(title_text="raised (count)", rangemode="tozero")
    figure.update_yaxes(title_text="alarm", autorange="reversed")
    people = f"n = {n} participant{'s' if n != 1 else ''} with an alarm."
    return drawn(ALARMS_KEY, ALARMS_TITLE, f"{what} {people}", n, figure, counts).of_group(
        "quality"
    )
