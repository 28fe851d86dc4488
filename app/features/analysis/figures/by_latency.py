"""A measure at each latency, one panel a limb: every participant's line, and the mean over them."""

import pandas as pd
import plotly.graph_objects as go

from app.features.analysis.figures.intervals import MeanInterval, mean_interval
from app.features.analysis.figures.theme import (
    BLUE,
    QUIET,
    VERMILLION,
    latency_axis,
    new_figure,
)

LIMBS = ("hand", "foot")
_LOOKS = {"hand": (BLUE, "circle", "solid"), "foot": (VERMILLION, "square", "dash")}
MEANS = (
    "Thin lines are participants; the thick line is their mean with its 95 % confidence interval "
    "(t distribution)."
)


def per_participant(frame: pd.DataFrame, value: str) -> pd.DataFrame:
    """One row per participant, limb and latency: the mean of `value`, as column `value`."""
    keys = ["participant_code", "limb", "latency_ms"]
    known = frame.dropna(subset=[*keys, value])
    return known.groupby(keys)[value].mean().rename("value").reset_index()


def latency_figure(
    values: pd.DataFrame, *, axis: str, unit: str, limits: tuple[float, float] | None = None
) -> go.Figure:
    """Draw `values` (participant_code, limb, latency_ms, value), one row a participant and cell.

    `axis` is the title of the y axis with its unit, `limits` the lowest and highest possible value.
    """
    limbs = [limb for limb in LIMBS if (values["limb"] == limb).any()]
    figure = new_figure(
        titles=tuple(f"{limb.capitalize()} task" for limb in limbs), shared_yaxes=True
    )
    for column, limb in enumerate(limbs, start=1):
        own = values[values["limb"] == limb]
        figure.add_trace(_people(own, unit, legend=column == 1), row=1, col=column)
        figure.add_trace(_means(own, limb, unit), row=1, col=column)
    latency_axis(figure, sorted(values["latency_ms"].unique().tolist()))
    figure.update_yaxes(title_text=axis, row=1, col=1)
    if limits is not None:
        room = 0.05 * (limits[1] - limits[0])
        figure.update_yaxes(range=[limits[0] - room, limits[1] + room])
    return figure


def cells(values: pd.DataFrame) -> dict[float, MeanInterval]:
    """Mean and interval at each latency, in order."""
    by_latency = values.sort_values("latency_ms").groupby("latency_ms")["value"]
    return {float(str(at)): mean_interval(group.tolist()) for at, group in by_latency}


def _people(own: pd.DataFrame, unit: str, *, legend: bool) -> go.Scatter:
    """All participants as one trace, with a gap between their lines."""
    x: list[float | None] = []
    y: list[float | None] = []
    names: list[str | None] = []
    for code, line in own.sort_values("latency_ms").groupby("participant_code"):
        x += [*line["latency_ms"].tolist(), None]
        y += [*line["value"].tolist(), None]
        names += [*([str(code)] * len(line)), None]
    return go.Scatter(
        x=x,
        y=y,
        text=names,
        mode="lines+markers",
        name="participants",
        legendgroup="participants",
        showlegend=legend,
        line={"color": QUIET, "width": 1},
        marker={"color": QUIET, "size": 5, "symbol": "circle-open"},
        hovertemplate=f"%{{text}}<br>%{{y:.3g}} {unit} at %{{x:g}} ms<extra></extra>",
    )


def _means(own: pd.DataFrame, limb: str, unit: str) -> go.Scatter:
    colour, symbol, dash = _LOOKS[limb]
    means = cells(own)
    return go.Scatter(
        x=list(means),
        y=[cell.mean for cell in means.values()],
        error_y={
            "type": "data",
            "array": [cell.half_width for cell in means.values()],
            "color": colour,
            "thickness": 2,
            "width": 6,
        },
        customdata=[[cell.n, cell.words(unit)] for cell in means.values()],
        mode="lines+markers",
        name=f"mean, {limb}",
        line={"color": colour, "width": 3, "dash": dash},
        marker={"color": colour, "size": 10, "symbol": symbol},
        hovertemplate=(
            "mean %{y:.3g} %{customdata[1]} at %{x:g} ms<br>n = %{customdata[0]}<extra></extra>"
        ),
    )
