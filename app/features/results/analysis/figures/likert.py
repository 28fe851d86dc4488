"""Figures of the answers to each item: diverging bars per latency, one panel per limb.

Bars are centred on the middle of the scale: disagreement extends to the left, agreement to the
right, and the middle category half to either side.
"""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.by_latency import LIMBS
from app.features.results.analysis.figures.drawing import (
    Drawing,
    count_note,
    drawn,
    limb_note,
    participants,
    too_few,
)
from app.features.results.analysis.figures.theme import new_figure
from app.science.instruments import Instrument, Item

WHAT = (
    "Share of answers in each category, before any recoding, at each added latency. Bars are "
    "placed so that the middle of the scale is at 0 %: disagreement to the left (hatched), "
    "agreement to the right. Repeated and superseded forms are left out unless chosen."
)
# Brewer's PuOr, lightest in the middle; it can be read with any kind of colour vision.
_DISAGREE = ("#b35806", "#e08214", "#fdb863", "#fee0b6")
_AGREE = ("#d8daeb", "#b2abd2", "#8073ac", "#542788")
_MIDDLE = "#c9c9c9"
_HATCH = {"size": 5, "solidity": 0.18, "fgcolor": "rgba(0, 0, 0, 0.55)", "fillmode": "overlay"}
_OUTLINE = "rgba(90, 90, 90, 0.9)"
_BAR_PX, _TEXT_PX, _FOOT_PX, _LINE_CHARACTERS = 17, 27, 150, 110
MAX_CATEGORIES = 9


@dataclass(frozen=True)
class _Category:
    """An answer category: value, label and style, and its side of the middle (-1, 0, 1)."""

    value: int
    label: str
    colour: str
    pattern: str
    side: float


def likert_drawings(
    answers: pd.DataFrame, instruments: Mapping[tuple[str, int], Instrument]
) -> Iterator[Drawing]:
    """Yield one drawing per questionnaire that is answered after phases, from valid rows."""
    rated = answers[answers["item_type"].eq("likert")].dropna(subset=["limb", "value_number"])
    if rated.empty:
        yield too_few(
            "likert", "Answers by item", WHAT, 0, "answered a questionnaire after a phase"
        ).of_group("answers", wide=True)
    for key, own in rated.groupby("instrument"):
        # The wording may differ between versions; that of the newest is shown.
        newest = instruments[str(key), int(own["instrument_version"].max())]
        for first, drawing in enumerate(_of_instrument(own, newest)):
            yield drawing.of_group("answers", wide=True) if first == 0 else drawing


def _of_instrument(own: pd.DataFrame, instrument: Instrument) -> Iterator[Drawing]:
    key, title = f"likert_{instrument.key}", f"Answers: {_english(instrument.title)}"
    items = [item for item in instrument.items if item.type == "likert"]
    scale = instrument.scale or next((item.scale for item in items if item.scale), None)
    rated = [item for item in items if instrument.scale_of(item) == scale]
    if scale is None or scale.maximum - scale.minimum + 1 > MAX_CATEGORIES:
        return
    categories = _categories(scale.minimum, scale.maximum, [_english(one) for one in scale.labels])
    n = participants(own)
    shares = _shares(own[own["item"].isin([item.key for item in rated])])
    figure = _figure(shares, rated, categories)
    stem = f"Each statement follows “{_english(instrument.stem)}”" if instrument.stem else ""
    caption = f"{stem} {WHAT} {count_note(n)} {limb_note(own)}"
    yield drawn(key, title, caption, n, figure, shares)


def _english(text: Mapping[str, str]) -> str:
    return text.get("en") or next(iter(text.values()))


def _categories(low: int, high: int, labels: Sequence[str]) -> list[_Category]:
    middle = (low + high) / 2.0
    half = (high - low + 1) // 2
    found = []
    for place, value in enumerate(range(low, high + 1)):
        label = f"{value} {labels[place]}" if place < len(labels) else f"{value}"
        if value == middle:
            found.append(_Category(value, label, _MIDDLE, ".", 0.0))
        elif value < middle:
            found.append(_Category(value, label, _spread(_DISAGREE, place, half), "/", -1.0))
        else:
            at = place - (high - low + 1 - half)
            found.append(_Category(value, label, _spread(_AGREE, at, half), "", 1.0))
    return found


def _spread(colours: Sequence[str], place: int, count: int) -> str:
    """Return the colour of category `place` of `count`, spread over the whole range of colours."""
    if count == 1:
        return colours[1]
    return colours[round(place * (len(colours) - 1) / (count - 1))]


def _shares(own: pd.DataFrame) -> pd.DataFrame:
    """Return shares of answers: item, limb, latency_ms, answer, count, percent, n."""
    keys = ["item", "limb", "latency_ms"]
    counts = own.groupby([*keys, "value_number"]).size().rename("count").reset_index()
    counts["n"] = counts.groupby(keys)["count"].transform("sum")
    counts["percent"] = 100.0 * counts["count"] / counts["n"]
    return counts.rename(columns={"value_number": "answer"})


def _figure(
    shares: pd.DataFrame, items: Sequence[Item], categories: Sequence[_Category]
) -> go.Figure:
    limbs = [limb for limb in LIMBS if (shares["limb"] == limb).any()]
    latencies = sorted(float(one) for one in shares["latency_ms"].unique())
    places = _places(items, latencies)
    figure = new_figure(
        titles=tuple(f"{limb.capitalize()} task" for limb in limbs),
        shared_yaxes=True,
        horizontal_spacing=0.04,
    )
    for column, limb in enumerate(limbs, start=1):
        own = shares[shares["limb"] == limb]
        for trace in _bars(own, places, categories, legend=column == 1):
            figure.add_trace(trace, row=1, col=column)
        figure.update_xaxes(
            title_text="share of answers (%)",
            range=[-100, 100],
            tickvals=[-100, -50, 0, 50, 100],
            ticktext=["100", "50", "0", "50", "100"],
            row=1,
            col=column,
        )
    _label(figure, items, latencies, places)
    figure.update_layout(barmode="overlay", bargap=0.12)
    return figure


def _places(items: Sequence[Item], latencies: Sequence[float]) -> dict[tuple[str, float], float]:
    """Return the y position of each bar, from the top; above an item's bars is its text."""
    room = _TEXT_PX / _BAR_PX
    return {
        (item.key, latency): at * (len(latencies) + room) + room + place
        for at, item in enumerate(items)
        for place, latency in enumerate(latencies)
    }


def _bars(
    own: pd.DataFrame,
    places: Mapping[tuple[str, float], float],
    categories: Sequence[_Category],
    *,
    legend: bool,
) -> Iterator[go.Bar]:
    columns = [own[name].tolist() for name in ("item", "latency_ms", "answer")]
    numbers = [own[name].astype("float64").tolist() for name in ("percent", "count", "n")]
    percent = {
        (str(item), float(latency), int(answer)): cell
        for item, latency, answer, cell in zip(*columns, zip(*numbers, strict=True), strict=True)
    }
    begin = _begins(places, percent, categories)
    for one in categories:
        cells = {at: percent.get((*at, one.value), (0.0, 0, 0)) for at in places}
        shown = {at: cell for at, cell in cells.items() if cell[0] > 0}
        yield go.Bar(
            orientation="h",
            y=[places[at] for at in shown],
            x=[cell[0] for cell in shown.values()],
            base=[begin[at] for at in shown],
            customdata=[[at[1], cell[1], cell[2]] for at, cell in shown.items()],
            name=one.label,
            legendgroup=one.label,
            showlegend=legend,
            width=0.86,
            marker={
                "color": one.colour,
                "line": {"color": _OUTLINE, "width": 0.6},
                "pattern": {"shape": one.pattern, **_HATCH},
            },
            hovertemplate=(
                f"{one.label}: %{{customdata[1]}} of %{{customdata[2]}} answers (%{{x:.0f}} %) at "
                "%{customdata[0]:g} ms<extra></extra>"
            ),
        )
        for at, cell in shown.items():
            begin[at] += cell[0]


def _begins(
    places: Mapping[tuple[str, float], float],
    percent: Mapping[tuple[str, float, int], tuple[float, float, float]],
    categories: Sequence[_Category],
) -> dict[tuple[str, float], float]:
    """Return the left end of each stacked bar, so that the middle of the scale is at 0."""
    return {
        place: -sum(
            percent.get((*place, one.value), (0.0, 0.0, 0.0))[0] / (1.0 if one.side < 0 else 2.0)
            for one in categories
            if one.side <= 0
        )
        for place in places
    }


def _label(
    figure: go.Figure,
    items: Sequence[Item],
    latencies: Sequence[float],
    places: Mapping[tuple[str, float], float],
) -> None:
    bottom = max(places.values()) + 0.8
    figure.update_yaxes(
        range=[bottom, 0.0],
        tickvals=list(places.values()),
        ticktext=[f"{latency:g} ms" for _, latency in places],
        showgrid=False,
        zeroline=False,
    )
    figure.update_yaxes(title_text="added latency", title_standoff=4, row=1, col=1)
    for item in items:
        words = textwrap.shorten(_english(item.text), _LINE_CHARACTERS, placeholder=" …")
        figure.add_annotation(
            text=f"<b>{item.key}</b>  {words}",
            x=0.0,
            xref="paper",
            xanchor="left",
            y=places[item.key, latencies[0]] - 0.55,
            yref="y",
            yanchor="bottom",
            showarrow=False,
            align="left",
            font={"size": 12},
        )
    figure.update_layout(height=round(bottom * _BAR_PX) + _FOOT_PX, margin={"b": 120})
