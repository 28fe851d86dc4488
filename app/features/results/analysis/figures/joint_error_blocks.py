"""The figure of the mean joint error over the blocks of a session."""

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
from app.features.results.analysis.figures.joint_errors import (
    INTERVAL,
    error_definition,
    task_angles,
)
from app.features.results.analysis.figures.theme import (
    COLOURS,
    NO_LEGEND_PX,
    LineEnd,
    label_line_ends,
    latency_line,
)

KEY, TITLE = "joint_error_blocks", "Joint error over the blocks of a session"
HOW = (
    "Each value is a participant's mean over joints and the active time of one phase. Where "
    "each participant has a latency in only one block, a line joins different participants."
)
_APART = 0.05
_NAMES = ("limb", "latency_ms", "block", "mean_deg", "ci95_low_deg", "ci95_high_deg", "n")


def joint_error_blocks_drawing(errors: pd.DataFrame) -> Drawing:
    """Draw the mean angle by block, one line per latency and panel per limb, from valid rows."""
    rows = task_angles(errors).dropna(subset=["block", "limb", "latency_ms"])
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, HOW, n, "joint errors").of_group("movement")
    keys = ["limb", "latency_ms", "block", "participant_code"]
    values = rows.astype({"block": "float64"}).groupby(keys)["mean_deg"].mean()
    data = _means(values.rename("value").reset_index())
    caption = f"{HOW} {error_definition(rows)} {INTERVAL} {count_note(n)}"
    return drawn(KEY, TITLE, caption, n, _figure(data), data).of_group("movement")


def _means(values: pd.DataFrame) -> pd.DataFrame:
    """Return mean and interval over participants for every limb, latency and block that occurs."""
    found = []
    for (limb, latency), own in values.groupby(["limb", "latency_ms"]):
        for block, cell in cells(own, "block").items():
            half = cell.half_width
            ends = (None, None) if half is None else (cell.mean - half, cell.mean + half)
            found.append((limb, latency, block, cell.mean, *ends, cell.n))
    return pd.DataFrame(found, columns=list(_NAMES))


def _figure(data: pd.DataFrame) -> go.Figure:
    limbs, latencies, figure = limb_panels(data)
    for column, limb in enumerate(limbs, start=1):
        for place, latency in enumerate(latencies):
            own = data[(data["limb"] == limb) & (data["latency_ms"] == latency)]
            # Shift the lines slightly, so that no interval hides another.
            shift = _APART * (place - 0.5 * (len(latencies) - 1))
            trace = _trace(own, latency, place, shift)
            figure.add_trace(trace.update(showlegend=column == 1), row=1, col=column)
        label_line_ends(
            figure,
            _ends(data[data["limb"] == limb], latencies),
            top=float(data["mean_deg"].max()),
            column=column,
        )
    blocks = sorted(data["block"].unique().tolist())
    # The lines are labelled at their ends, to the right of which is room for it.
    figure.update_layout(showlegend=False, margin={"b": NO_LEGEND_PX})
    figure.update_xaxes(
        title_text="block (1 = first)",
        tickvals=blocks,
        range=[blocks[0] - 0.3, blocks[-1] + 0.3 + 0.2 * (len(blocks) - 1)],
    )
    figure.update_yaxes(rangemode="tozero")
    figure.update_yaxes(title_text="mean joint error (deg)", row=1, col=1)
    return figure


def _ends(own: pd.DataFrame, latencies: list[float]) -> list[LineEnd]:
    """Return the ends of the lines, all at the last block, so that their labels are in a column."""
    ends = []
    for place, latency in enumerate(latencies):
        line = own[own["latency_ms"] == latency].sort_values("block")
        if line.empty:
            continue
        x = float(line["block"].iloc[-1]) + 0.5 * _APART * len(latencies)
        y = float(line["mean_deg"].iloc[-1])
        ends.append(LineEnd(x, y, f"{latency:g} ms", COLOURS[place % len(COLOURS)]))
    return ends


def _trace(own: pd.DataFrame, latency: float, place: int, shift: float) -> go.Scatter:
    half = (own["ci95_high_deg"] - own["mean_deg"]).astype("float64")
    return go.Scatter(
        x=[block + shift for block in own["block"]],
        y=own["mean_deg"].tolist(),
        error_y={
            "type": "data",
            "array": [None if pd.isna(one) else float(one) for one in half],
            "color": COLOURS[place % len(COLOURS)],
        },
        customdata=own[["block", "n"]].to_numpy().tolist(),
        hovertemplate=(
            f"{latency:g} ms: mean %{{y:.2f}} deg in block %{{customdata[0]:g}}"
            "<br>n = %{customdata[1]:g}<extra></extra>"
        ),
        **latency_line(latency, place, size_px=9),
    )
