"""The figure of the mean joint error over the active time of a phase."""

from collections.abc import Sequence

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.by_latency import cells, limb_panels
from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    participants,
    too_few,
)
from app.features.results.analysis.figures.joint_errors import HINGES
from app.features.results.analysis.figures.theme import (
    COLOURS,
    NO_LEGEND_PX,
    LineEnd,
    label_line_ends,
    latency_line,
    see_through,
)
from app.protocol import COUNTED_KINDS

KEY, TITLE = "joint_error_course", "Joint error over the active time of a phase"
HOW = (
    "Shows whether participants adapt to a latency or tire during a phase. Joint error is the "
    "angle between the participant's current pose and the body they saw; it also grows with "
    "their speed. Each value is a participant's mean over joints and frames in a step of "
    "active time, which stops in pauses and on walks back. The hips carry no latency and are left "
    "out."
)
BANDS = (
    "Lines are means over participants, bands their 95 % confidence intervals (t distribution), "
    "computed for each step."
)
LABEL_MARGIN_PX = 60
_KEYS = ["limb", "latency_ms", "begin_active_s", "end_active_s"]
_NAMES = (*_KEYS, "mean_deg", "ci95_low_deg", "ci95_high_deg", "n")


def joint_error_course_drawing(courses: pd.DataFrame) -> Drawing:
    """Draw the mean angle by active time, one line per latency and one panel per limb.

    `courses` are valid rows of the table of joint errors over time.
    """
    chosen = courses["reference"].eq("present") & courses["phase_kind"].isin(COUNTED_KINDS)
    rows = courses[chosen].dropna(subset=[*_KEYS, "mean_deg"])
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, HOW, n, "joint errors").of_group("movement")
    values = rows.groupby([*_KEYS, "participant_code"])["mean_deg"].mean()
    data = _means(values.rename("value").reset_index())
    hinges = HINGES if rows["avatar"].eq("physics").any() else ""
    caption = f"{HOW} {hinges} {_steps_note(data)} {BANDS} {count_note(n)}"
    return drawn(KEY, TITLE, caption, n, _figure(data), data).of_group("movement")


def _steps_note(data: pd.DataFrame) -> str:
    longest_s = float((data["end_active_s"] - data["begin_active_s"]).max())
    return f"A step is {longest_s:g} s long, and its point is in its middle."


def _means(values: pd.DataFrame) -> pd.DataFrame:
    """Return mean and interval over participants for every limb, latency and step that occurs."""
    found = []
    for place, own in values.groupby(_KEYS[:2]):
        ends_s = own.groupby("begin_active_s")["end_active_s"].max()
        for begin_s, cell in cells(own, "begin_active_s").items():
            half = cell.half_width
            ends = (None, None) if half is None else (cell.mean - half, cell.mean + half)
            found.append((*place, begin_s, float(ends_s[begin_s]), cell.mean, *ends, cell.n))
    return pd.DataFrame(found, columns=list(_NAMES)).astype({"ci95_low_deg": "float64"})


def _figure(data: pd.DataFrame) -> go.Figure:
    limbs, latencies, figure = limb_panels(data)
    for column, limb in enumerate(limbs, start=1):
        owns = [
            data[(data["limb"] == limb) & (data["latency_ms"] == latency)] for latency in latencies
        ]
        # Add all bands first, so that none covers a line.
        for place, (latency, own) in enumerate(zip(latencies, owns, strict=True)):
            figure.add_trace(_band(own, latency, place), row=1, col=column)
        for place, (latency, own) in enumerate(zip(latencies, owns, strict=True)):
            line = _line(own, latency, place).update(showlegend=column == 1)
            figure.add_trace(line, row=1, col=column)
        label_line_ends(
            figure, _ends(latencies, owns), top=float(data["mean_deg"].max()), column=column
        )
    # The lines are labelled at their ends, beside the panels.
    figure.update_layout(showlegend=False, margin={"r": LABEL_MARGIN_PX, "b": NO_LEGEND_PX})
    figure.update_xaxes(
        title_text="active time (s)", range=[0.0, float(data["end_active_s"].max())]
    )
    figure.update_yaxes(rangemode="tozero")
    figure.update_yaxes(title_text="mean joint error (deg)", row=1, col=1)
    return figure


def _ends(latencies: Sequence[float], owns: Sequence[pd.DataFrame]) -> list[LineEnd]:
    return [
        LineEnd(
            _middles(own)[-1],
            float(own["mean_deg"].iloc[-1]),
            f"{latency:g} ms",
            COLOURS[place % len(COLOURS)],
        )
        for place, (latency, own) in enumerate(zip(latencies, owns, strict=True))
        if not own.empty
    ]


def _band(own: pd.DataFrame, latency: float, place: int) -> go.Scatter:
    """Return the band of the intervals, from the start of the first step to the end of the last.

    Where steps are missing, the band has a gap.
    """
    complete = own.dropna(subset=["ci95_low_deg", "ci95_high_deg"])
    x: list[float | None] = []
    y: list[float | None] = []
    unbroken = complete["begin_active_s"].ne(complete["end_active_s"].shift()).cumsum()
    for _, part in complete.groupby(unbroken):
        edge = [part["begin_active_s"].iloc[0], *_middles(part), part["end_active_s"].iloc[-1]]
        low, high = (
            [values[0], *values, values[-1]]
            for values in (part["ci95_low_deg"].tolist(), part["ci95_high_deg"].tolist())
        )
        x += [*edge, *reversed(edge), None]
        y += [*high, *reversed(low), None]
    return go.Scatter(
        x=x,
        y=y,
        mode="lines",
        fill="toself",
        fillcolor=see_through(COLOURS[place % len(COLOURS)]),
        line={"width": 0},
        hoverinfo="skip",
        name=f"95 % interval, {latency:g} ms",
        legendgroup=f"{latency:g}",
        showlegend=False,
    )


def _line(own: pd.DataFrame, latency: float, place: int) -> go.Scatter:
    half = (own["ci95_high_deg"] - own["mean_deg"]).astype("float64")
    words = ["no interval" if pd.isna(one) else f"± {one:.2g} deg" for one in half]
    steps = zip(own["begin_active_s"], own["end_active_s"], words, own["n"], strict=True)
    return go.Scatter(
        x=_middles(own),
        y=own["mean_deg"].tolist(),
        customdata=[list(step) for step in steps],
        hovertemplate=(
            f"{latency:g} ms: mean %{{y:.2f}} deg (%{{customdata[2]}}) from %{{customdata[0]:g}} "
            "to %{customdata[1]:g} s<br>n = %{customdata[3]:g}<extra></extra>"
        ),
        **latency_line(latency, place, size_px=7),
    )


def _middles(own: pd.DataFrame) -> list[float]:
    return ((own["begin_active_s"] + own["end_active_s"]) / 2.0).tolist()
