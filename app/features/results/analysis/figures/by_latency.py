"""Figures of a measure at each latency: each participant's line and the mean, by limb."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
import plotly.graph_objects as go
from scipy.special import stdtrit

from app.features.results.analysis.figures.theme import (
    BLUE,
    CALM,
    GREEN,
    NO_LEGEND_PX,
    VERMILLION,
    latency_axis,
    new_figure,
    quiet,
)

LEVEL = 0.95
LIMBS = ("hand", "foot")
ROAD = "road"
"""Stands for a limb where something is done with none: crossing the road."""
_PANELS = {"hand": "Hand task", "foot": "Foot task", ROAD: "On the road"}
_STYLES = {
    "hand": (BLUE, "circle", "solid"),
    "foot": (VERMILLION, "square", "dash"),
    ROAD: (GREEN, "diamond", "solid"),
}
MEANS = (
    "Thin lines are participants; the thick line is their mean with its 95 % confidence interval "
    "(t distribution). The shape beside it is the distribution of 5 or more participants; n "
    "is beside each panel's title, from the smallest to the largest where latencies differ. "
    "A triangle marks an interval that goes on beyond the possible values."
)
MIN_FOR_A_SHAPE = 5
MANY = 60
"""With more participants than this, points are left out and lines are fainter."""
SHAPE_SHARE = 0.16
"""Width of a shape as a share of the distance between two neighbours on the x axis."""


@dataclass(frozen=True)
class MeanInterval:
    """The mean of n values and half the width of its 95 % interval (None for a single value)."""

    mean: float
    half_width: float | None
    n: int

    def words(self, unit: str) -> str:
        """Return the half width as text with its unit, for a hover text."""
        if self.half_width is None:
            return f"{unit} (one participant, no interval)"
        return f"± {self.half_width:.2g} {unit}"


def mean_interval(values: Sequence[float]) -> MeanInterval:
    """Return Student's interval: mean +- t(.975, n - 1) s / sqrt(n).

    Raises ValueError if there are no values.
    """
    if len(values) == 0:
        raise ValueError("expected at least one value, got none")
    array = np.asarray(values, np.float64)
    n, mean = len(array), float(array.mean())
    if n < 2:
        return MeanInterval(mean, None, n)
    quantile = float(stdtrit(n - 1, 0.5 + LEVEL / 2))
    return MeanInterval(mean, quantile * float(array.std(ddof=1)) / n**0.5, n)


@dataclass(frozen=True)
class Across:
    """The quantity on the x axis: its column in the table, its title and its unit.

    `names`: of categories, whose column has their index; they have no distance from each other, so
    no lines are drawn between their means.
    """

    column: str
    title: str
    unit: str
    names: tuple[str, ...] = ()

    def tick(self, place: float) -> str:
        """Return the label of a place on the axis."""
        return self.names[int(place)] if self.names else f"{place:g}"


LATENCY = Across("latency_ms", "added latency (ms)", "ms")


def per_participant(frame: pd.DataFrame, value: str, across: str = LATENCY.column) -> pd.DataFrame:
    """Return the mean of the column `value` per participant, limb and latency."""
    keys = ["participant_code", "limb", across]
    complete = frame.dropna(subset=[*keys, value])
    return complete.groupby(keys)[value].mean().rename("value").reset_index()


def latency_figure(
    values: pd.DataFrame,
    *,
    axis: str,
    unit: str,
    limits: tuple[float, float] | None = None,
    across: Across = LATENCY,
) -> go.Figure:
    """Draw a measure at each latency, one panel per limb.

    `values` has one row per participant, limb and latency (participant_code, limb, latency_ms,
    value). `axis` is the title of the y axis with its unit, `limits` the lowest and highest
    possible value.
    """
    limbs = [limb for limb in _PANELS if (values["limb"] == limb).any()]
    places = sorted(float(place) for place in values[across.column].unique())
    figure = new_figure(titles=tuple(_PANELS[limb] for limb in limbs) or ("",), shared_yaxes=True)
    latency_axis(figure, places)
    for column, limb in enumerate(limbs, start=1):
        own = values[values["limb"] == limb].rename(columns={across.column: "x"})
        for trace in (*_shapes(own, limb, places, unit), _people(own, unit, across, column == 1)):
            figure.add_trace(trace, row=1, col=column)
        figure.add_trace(_means(own, limb, unit, across), row=1, col=column)
        for trace in _beyond(own, limb, unit, _room(limits)):
            figure.add_trace(trace, row=1, col=column)
        figure.update_xaxes(
            title_text=across.title,
            ticktext=[across.tick(place) for place in places],
            row=1,
            col=column,
        )
        # Never below the ticks: figures side by side then have their axes at the same heights.
        figure.layout.annotations[column - 1].text += f", {_count_words(own, places)}"
    # Panels, lines and shapes are named where they are, and by the caption.
    figure.update_layout(showlegend=False, margin={"b": NO_LEGEND_PX})
    figure.update_xaxes(title_font_size=13, title_standoff=4, tickangle=0)
    figure.update_yaxes(title_text=axis, row=1, col=1)
    if limits is not None:
        figure.update_yaxes(range=_room(limits))
    return figure


def _room(limits: tuple[float, float] | None) -> tuple[float, float] | None:
    """Return the ends of the y axis: the possible values, and a margin."""
    if limits is None:
        return None
    room = 0.05 * (limits[1] - limits[0])
    return limits[0] - room, limits[1] + room


def _count_words(own: pd.DataFrame, places: Sequence[float]) -> str:
    """Return the number of participants, or the smallest and the largest where places differ."""
    counts = own.groupby("x")["value"].count()
    numbers = [int(counts.get(place, 0)) for place in places]
    low, high = min(numbers), max(numbers)
    return f"n = {low}" if low == high else f"n = {low}–{high}"


def drawn_rows(values: pd.DataFrame, unit: str, across: Across = LATENCY) -> pd.DataFrame:
    """Return the rows that `latency_figure` draws: participants' values, means, intervals."""
    rows = [values.assign(row="participant")]
    for limb in _PANELS:
        own = values[values["limb"] == limb].rename(columns={across.column: "x"})
        means = [
            {
                "row": "mean",
                "limb": limb,
                across.column: at,
                "value": cell.mean,
                "ci95_low": None if cell.half_width is None else cell.mean - cell.half_width,
                "ci95_high": None if cell.half_width is None else cell.mean + cell.half_width,
                "n": cell.n,
            }
            for at, cell in cells(own, "x").items()
        ]
        rows += [pd.DataFrame(means)] if means else []
    frame = pd.concat(rows, ignore_index=True).assign(unit=unit)
    names = ("row", "participant_code", "limb", across.column, "value", "ci95_low", "ci95_high")
    return frame.reindex(columns=[*names, "n", "unit"])


def limb_panels(data: pd.DataFrame) -> tuple[list[str], list[float], go.Figure]:
    """Return the limbs and latencies (ms) in `data`, and an empty figure with a panel per limb."""
    limbs = [limb for limb in LIMBS if (data["limb"] == limb).any()]
    latencies_ms = sorted(data["latency_ms"].unique().tolist())
    titles = tuple(f"{limb.capitalize()} task" for limb in limbs)
    return limbs, latencies_ms, new_figure(titles=titles, shared_yaxes=True)


def cells(values: pd.DataFrame, across: str = LATENCY.column) -> dict[float, MeanInterval]:
    """Return the mean and interval at each latency, in ascending order of latency."""
    by_place = values.sort_values(across).groupby(across)["value"]
    return {float(str(at)): mean_interval(group.tolist()) for at, group in by_place}


def _shapes(own: pd.DataFrame, limb: str, places: Sequence[float], unit: str) -> list[go.Violin]:
    """Return a half violin to the right of each x value; omit those with few participants."""
    gap = min((b - a for a, b in itertools.pairwise(places)), default=10.0)
    traces = []
    for place, group in own.groupby("x")["value"]:
        if len(group) < MIN_FOR_A_SHAPE or group.nunique() < 2:
            continue
        traces.append(
            go.Violin(
                # dtype=object: plotly would encode numeric arrays in binary, and inspect a list's
                # items.
                x=np.full(len(group), float(str(place)) + 0.06 * gap, dtype=object),
                y=group.to_numpy(dtype=object),
                name=f"distribution, {limb}",
                side="positive",
                width=2 * SHAPE_SHARE * gap,
                points=False,
                spanmode="hard",
                line={"color": _STYLES[limb][0], "width": 1},
                fillcolor=CALM,
                showlegend=False,
                hovertemplate=f"%{{y:.3g}} {unit}<extra>distribution</extra>",
            )
        )
    return traces


def _people(own: pd.DataFrame, unit: str, across: Across, legend: bool) -> go.Scatter:  # noqa: FBT001 - one of two panels
    """Return one trace with the lines of all participants, separated by gaps."""
    lines = own.sort_values(["participant_code", "x"])
    codes = lines["participant_code"].to_numpy(dtype=object)
    # The index after the last point of each line.
    gaps = np.append(np.flatnonzero(codes[1:] != codes[:-1]) + 1, len(codes))
    nothing = np.array([None], dtype=object)

    def parted(values: npt.NDArray[np.object_]) -> npt.NDArray[np.object_]:
        return np.insert(values, gaps, nothing)

    n = own["participant_code"].nunique()
    colour = quiet(n)
    return go.Scatter(
        x=parted(lines["x"].to_numpy(dtype=object)),
        y=parted(lines["value"].to_numpy(dtype=object)),
        text=parted(codes),
        mode="lines" if n > MANY else "lines+markers",
        name="participants",
        legendgroup="participants",
        showlegend=legend,
        line={"color": colour, "width": 1},
        marker={"color": colour, "size": 5, "symbol": "circle-open"},
        hovertemplate=f"%{{text}}<br>%{{y:.3g}} {unit}{_place_words(across)}<extra></extra>",
    )


def _beyond(
    own: pd.DataFrame, limb: str, unit: str, ends: tuple[float, float] | None
) -> list[go.Scatter]:
    """Return a triangle at each end of the y axis where intervals go on beyond it."""
    if ends is None:
        return []
    traces = []
    for end, symbol, sign in zip(ends, ("triangle-down", "triangle-up"), (-1, 1), strict=True):
        found = {
            at: cell.mean + sign * cell.half_width
            for at, cell in cells(own, "x").items()
            if cell.half_width is not None
            and sign * (cell.mean + sign * cell.half_width) > sign * end
        }
        if not found:
            continue
        traces.append(
            go.Scatter(
                x=list(found),
                y=[end] * len(found),
                customdata=list(found.values()),
                mode="markers",
                marker={"color": _STYLES[limb][0], "size": 9, "symbol": symbol},
                cliponaxis=False,
                name=f"interval goes on, {limb}",
                hovertemplate=f"the interval goes on to %{{customdata:.3g}} {unit}<extra></extra>",
            )
        )
    return traces


def _place_words(across: Across) -> str:
    """Return the end of a hover text: where on the axis; categories stand below the axis."""
    return "" if across.names else f" at %{{x:g}} {across.unit}"


def _means(own: pd.DataFrame, limb: str, unit: str, across: Across) -> go.Scatter:
    colour, symbol, dash = _STYLES[limb]
    means = cells(own, "x")
    *_, before, last = (0.0, *(cell.mean for cell in means.values()))
    rises = last >= before
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
        mode="markers" if across.names else "lines+markers+text",
        text=[*("" for _ in range(len(means) - 1)), "mean"],
        # Where the line does not come from.
        textposition="top left" if rises else "bottom left",
        textfont={"color": colour, "size": 12},
        cliponaxis=False,
        name=f"mean, {limb}",
        line={"color": colour, "width": 3, "dash": dash},
        marker={"color": colour, "size": 10, "symbol": symbol},
        hovertemplate=(
            f"mean %{{y:.3g}} %{{customdata[1]}}{_place_words(across)}"
            "<br>n = %{customdata[0]}<extra></extra>"
        ),
    )
