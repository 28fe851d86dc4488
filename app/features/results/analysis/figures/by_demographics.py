"""Figures of the embodiment scores against what participants answered about themselves.

One figure per score with a panel for each variable, and a point for each participant. They explore:
a dozen people have a dozen ages, and among many panels one looks striking by chance.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.demographics import (
    KEY,
    Variable,
    relations_of,
    variables_of,
)
from app.features.results.analysis.figures.by_latency import MANY, per_participant
from app.features.results.analysis.figures.drawing import (
    Drawing,
    count_note,
    drawn,
    too_few,
)
from app.features.results.analysis.figures.embodiment import COMPONENTS
from app.features.results.analysis.figures.theme import BLUE, QUIET, VERMILLION, new_figure
from app.science.instruments import Instrument
from app.science.statistics import Explored

WHAT = (
    "Each point is a participant: the mean of the score over all conditions and tasks. Dashes are "
    "medians of 3 or more. ρ is Spearman's rank correlation, ε² the effect size of Kruskal and "
    "Wallis. Exploratory: among so many panels one looks striking by chance."
)
COLUMNS = 2
_PANEL_PX, _FOOT_PX = 170, 30
_FEWEST_FOR_A_MEDIAN = 3
_WORD_CHARACTERS = 12
_SIDEWAYS = 0.09
"""How far points of one category are moved apart, of a category's width of 1."""


def demographics_drawings(
    scores: pd.DataFrame,
    answers: pd.DataFrame,
    instruments: Mapping[tuple[str, int], Instrument],
) -> Iterator[Drawing]:
    """Yield one drawing per embodiment component, from valid rows of scores and answers."""
    for score, (name, _) in COMPONENTS.items():
        rows = scores[scores["score"] == score].dropna(subset=["limb", "value"])
        means = per_participant(rows, "value").groupby("participant_code")["value"].mean()
        variables = variables_of(answers, list(means.index), instruments)
        drawing = _drawing(f"demographics_{score}", f"{name} by demographics", means, variables)
        yield drawing.of_group("demographics")


def _drawing(
    key: str, title: str, means: "pd.Series[float]", variables: Sequence[Variable]
) -> Drawing:
    n = len(means)
    shown = [one for one in variables if one.differs]
    if not shown:
        return too_few(key, title, WHAT, n, "an answer that differs from another's")
    found = {one.variable: one for one in relations_of(means, variables)}
    alike = ", ".join(one.name for one in variables if not one.differs)
    same = f"The same for everybody, so not drawn: {alike}." if alike else ""
    figure, data = _figure(shown, means, found), _rows(shown, means, found)
    return drawn(key, title, f"{WHAT} {count_note(n)} {same}", n, figure, data).tested_as(KEY)


def _figure(
    shown: Sequence[Variable], means: "pd.Series[float]", found: Mapping[str, Explored]
) -> go.Figure:
    rows = -(-len(shown) // COLUMNS)
    titles = [_panel_title(one, found[one.heading]) for one in shown]
    titles += [""] * (rows * COLUMNS - len(shown))
    figure = new_figure(
        rows=rows,
        titles=tuple(titles),
        shared_yaxes=True,
        horizontal_spacing=0.06,
        vertical_spacing=0.44 / rows,
    )
    for at, variable in enumerate(shown):
        place = {"row": 1 + at // COLUMNS, "col": 1 + at % COLUMNS}
        for trace in _traces(variable, means):
            figure.add_trace(trace, **place)
        figure.update_xaxes(**_x_axis(variable), **place)
        if at % COLUMNS == 0:
            figure.update_yaxes(title_text="score (points)", title_font_size=12, **place)
    figure.update_annotations(font_size=12)
    figure.update_layout(
        showlegend=False, height=rows * _PANEL_PX + _FOOT_PX, margin={"t": 44, "b": 44}
    )
    return figure


def _panel_title(variable: Variable, found: Explored) -> str:
    """Return the variable with its unit, and below how many answered and the effect."""
    effect = "" if found.why_not else f", {_effect_name(found)} = {_effect(found.effect)}"
    return f"{variable.heading}<br>n = {found.n}{effect}"


def _effect_name(found: Explored) -> str:
    return "ρ" if found.kind == "number" else "ε²"


def _effect(value: float) -> str:
    """Return a number of at most 1 with two decimals, as papers print it."""
    return f"{value:.2f}".replace("0.", ".", 1).replace("-", "−")


def _x_axis(variable: Variable) -> dict[str, object]:
    if variable.is_number:
        steps = variable.steps
        return {"tickvals": list(steps), "ticktext": list(steps.values())} if steps else {}
    counts = variable.values.value_counts()
    return {
        "tickvals": list(range(len(variable.words))),
        "ticktext": [f"{_short(word)}<br>n = {counts.get(word, 0)}" for word in variable.words],
        "tickangle": 0,
        "range": [-0.6, len(variable.words) - 0.4],
        "showgrid": False,
        "zeroline": False,
    }


def _short(word: str) -> str:
    return word if len(word) <= _WORD_CHARACTERS else f"{word[: _WORD_CHARACTERS - 1]}…"


def _traces(variable: Variable, means: "pd.Series[float]") -> Iterator[go.Scatter]:
    """Yield the participants, and of categories the medians."""
    both = pd.DataFrame({"answer": variable.values, "score": means}).dropna()
    if variable.is_number:
        yield _points(both["answer"].to_numpy(dtype=object), both["score"], variable.unit)
        return
    place = {word: at for at, word in enumerate(variable.words)}
    both = both.sort_values("score")
    # Neighbours in score are moved apart, so that no point covers another.
    sideways = _SIDEWAYS * ((both.groupby("answer").cumcount() % 5) - 2)
    x = both["answer"].map(place).astype("float64") + sideways
    yield _points(x.to_numpy(dtype=object), both["score"], "")
    sizes = both.groupby("answer")["score"].agg(["median", "size"])
    sizes = sizes[sizes["size"] >= _FEWEST_FOR_A_MEDIAN]
    yield go.Scatter(
        x=[place[str(word)] for word in sizes.index],
        y=sizes["median"].tolist(),
        mode="markers",
        name="median",
        marker={"symbol": "line-ew", "size": 34, "line": {"color": VERMILLION, "width": 2.5}},
        hovertemplate="median %{y:.3g} points<extra></extra>",
    )


def _points(x: "np.ndarray", scores: "pd.Series[float]", unit: str) -> go.Scatter:
    """Return the points of one panel, which do not say who somebody is."""
    many = len(scores) > MANY
    own = f"%{{x:g}} {unit}, " if unit else ""
    return go.Scatter(
        x=x,
        y=scores.to_numpy(dtype=object),
        mode="markers",
        name="participants",
        marker={
            "color": QUIET if many else BLUE,
            "size": 4 if many else 7,
            "symbol": "circle-open",
            "line": {"width": 1.5},
        },
        cliponaxis=False,
        hovertemplate=f"{own}%{{y:.3g}} points<extra></extra>",
    )


def _rows(
    shown: Sequence[Variable], means: "pd.Series[float]", found: Mapping[str, Explored]
) -> pd.DataFrame:
    """Return the points that are drawn, without codes, and each panel's relation."""
    points = [
        pd.DataFrame({"row": "participant", "variable": one.heading, "answer": one.values})
        .assign(score_points=means)
        .dropna(subset=["answer"])
        .sort_values("score_points")
        for one in shown
    ]
    relations = pd.DataFrame(
        [
            {
                "row": "relation",
                "variable": one.heading,
                "effect": _effect_name(found[one.heading]),
                "value": _finite(found[one.heading].effect),
                "p": _finite(found[one.heading].p),
                "p_holm": _finite(found[one.heading].p_holm),
                "n": found[one.heading].n,
            }
            for one in shown
        ]
    )
    return pd.concat([*points, relations], ignore_index=True)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
