"""The figure of the achieved latency against the set latency."""

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    participants,
    too_few,
)
from app.features.results.analysis.figures.theme import (
    BLUE,
    QUIET,
    VERMILLION,
    latency_axis,
    new_figure,
)
from app.protocol import COUNTED_KINDS

KEY, TITLE = "achieved_latency", "Achieved against set latency"
WHAT = (
    "Each point is a phase: the lag at which the avatar's joints match the participant's best, "
    "from the recorded frames, with its 95 % confidence interval. On the dashed line, achieved and "
    "set latency agree. Crosses deviate by more than 10 ms and more than a frame. Points are "
    "shifted sideways to be visible. A physics avatar adds a lag of its own."
)
LIMIT_MS = 10.0
_MAX_INTERVALS = 300
_STYLES = {False: ("as ordered", BLUE, "circle"), True: ("off", VERMILLION, "x")}
_COLUMNS = (
    *("participant_code", "session_id", "phase_id", "limb", "latency_ms", "achieved_latency_ms"),
    *("achieved_latency_low_ms", "achieved_latency_high_ms", "latency_off", "latency_reason"),
)


def achieved_drawing(phases: pd.DataFrame) -> Drawing:
    """Draw the achieved against the set latency of each task phase, from valid rows of `phases`."""
    tasks = phases[phases["phase_kind"].isin(COUNTED_KINDS)]
    measured = tasks.dropna(subset=["achieved_latency_ms", "latency_ms"])
    n = participants(measured)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, WHAT, n, "a phase whose achieved latency is known").of_group(
            "movement"
        )
    latencies = sorted(float(one) for one in measured["latency_ms"].unique())
    off = measured["latency_off"].fillna(value=False).astype(bool)
    figure = _figure(measured, off, latencies)
    unknown = len(tasks) - len(measured)
    caption = (
        f"{WHAT} {len(measured)} phases, {int(off.sum())} of them off; of {unknown} more the "
        f"achieved latency is not known. {count_note(n)}"
    )
    rows = measured[list(_COLUMNS)]
    return drawn(KEY, TITLE, caption, n, figure, rows).of_group("movement")


def _figure(measured: pd.DataFrame, off: pd.Series, latencies: list[float]) -> go.Figure:
    """Draw the achieved latency (left) and its deviation from the set latency (right)."""
    spread = 0.05 * max(latencies[-1] - latencies[0], 50.0)
    figure = new_figure(titles=("Achieved", "Achieved minus set"), horizontal_spacing=0.14)
    ends = [latencies[0] - spread, latencies[-1] + spread]
    figure.add_trace(_line(ends, ends, "achieved = set", "dash", legend=True), row=1, col=1)
    figure.add_trace(_line(ends, [0.0, 0.0], "achieved = set", "dash"), row=1, col=2)
    for place, limit in enumerate((LIMIT_MS, -LIMIT_MS)):
        line = _line(ends, [limit, limit], "10 ms off", "dot", legend=place == 0)
        figure.add_trace(line, row=1, col=2)
    for column, less in ((1, False), (2, True)):
        for flag, style in _STYLES.items():
            own = measured[off == flag]
            if len(own):
                points = _points(own, style, spread, less=less)
                figure.add_trace(points.update(showlegend=not less), row=1, col=column)
    latency_axis(figure, latencies)
    figure.update_xaxes(title_text="set latency (ms)")
    figure.update_yaxes(title_text="achieved latency (ms)", row=1, col=1)
    figure.update_yaxes(title_text="difference (ms)", row=1, col=2)
    return figure


def _line(
    x: list[float], y: list[float], name: str, dash: str, *, legend: bool = False
) -> go.Scatter:
    return go.Scatter(
        x=x,
        y=y,
        mode="lines",
        name=name,
        legendgroup=name,
        showlegend=legend,
        line={"color": QUIET, "dash": dash, "width": 2},
        hovertemplate=f"{name}<extra></extra>",
    )


def _points(
    own: pd.DataFrame, style: tuple[str, str, str], spread: float, *, less: bool
) -> go.Scatter:
    name, colour, symbol = style
    # Spread points sideways in the order of the rows, so that the same data give the same picture.
    place = own.groupby("latency_ms").cumcount() / own.groupby("latency_ms")[
        "latency_ms"
    ].transform("size").clip(lower=2)
    achieved = own["achieved_latency_ms"].to_numpy(dtype=np.float64)
    high = own["achieved_latency_high_ms"].to_numpy(dtype=np.float64) - achieved
    low = achieved - own["achieved_latency_low_ms"].to_numpy(dtype=np.float64)
    intervals = len(own) <= _MAX_INTERVALS
    return go.Scatter(
        x=(own["latency_ms"] + spread * (2.0 * place - 1.0)).tolist(),
        y=(achieved - own["latency_ms"].to_numpy() if less else achieved).tolist(),
        error_y={
            "type": "data",
            "array": _plain(high),
            "arrayminus": _plain(low),
            "color": colour,
            "thickness": 1,
            "width": 2,
        }
        if intervals
        else None,
        customdata=own[["participant_code", "limb", "latency_ms"]].to_numpy().tolist(),
        mode="markers",
        name=name,
        legendgroup=name,
        marker={"color": colour, "symbol": symbol, "size": 7 if intervals else 4},
        hovertemplate=(
            "%{customdata[0]}, %{customdata[1]}: %{y:.1f} ms "
            f"{'off' if less else 'achieved'}, %{{customdata[2]:g}} ms ordered<extra></extra>"
        ),
    )


def _plain(values: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
