"""The figure of joint errors as a heat map on a body, one body per latency."""

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
from app.features.results.analysis.figures.joint_errors import (
    error_definition,
    joint_rows,
    task_angles,
)
from app.features.results.analysis.figures.theme import new_figure
from app.science.skeleton import JOINT_NAMES, PARENTS, build_skeleton

KEY, TITLE = "joint_error_body", "Joint error on the body by added latency"
HOW = (
    "The body is seen from the front, so its left is on the right. Colour and size of each joint "
    "show its mean error over participants; the scale is the same for all latencies."
)
_STATURE_M = 1.75
_SMALLEST_PX, _LARGEST_PX = 7.0, 24.0
_BONE = "rgba(128, 128, 128, 0.55)"
_HEIGHT_PX = 400


def joint_error_body_drawing(errors: pd.DataFrame) -> Drawing:
    """Draw the mean error of every joint on a body, from valid rows of the joint errors."""
    rows = task_angles(errors)
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, HOW, n, "joint errors").of_group("movement", wide=True)
    means = joint_rows(rows)
    latencies = sorted(float(one) for one in means["latency_ms"].unique())
    largest = float(means["mean_deg"].max()) or 1.0
    figure = new_figure(
        titles=tuple(f"{latency:g} ms" for latency in latencies), horizontal_spacing=0.02
    )
    for column, latency in enumerate(latencies, start=1):
        own = means[means["latency_ms"] == latency].set_index("joint")
        figure.add_trace(_bones(), row=1, col=column)
        figure.add_trace(_joints(own, largest, latency), row=1, col=column)
    _room(figure, len(latencies), largest)
    caption = f"{HOW} {error_definition(rows)} {count_note(n)}"
    return drawn(KEY, TITLE, caption, n, figure, means).of_group("movement", wide=True)


def _places() -> dict[str, tuple[float, float]]:
    """Return the position of every joint in the T-pose, in m: (x to the viewer's right, y up)."""
    skeleton = build_skeleton(_STATURE_M)
    places: dict[str, tuple[float, float]] = {}
    for index, name in enumerate(JOINT_NAMES):
        x, y, _ = (float(one) for one in skeleton.offsets_m[index])
        above = places.get(JOINT_NAMES[PARENTS[index]]) if PARENTS[index] >= 0 else None
        # The body faces the viewer: its right, +x, is on the viewer's left.
        places[name] = (-x, y) if above is None else (above[0] - x, above[1] + y)
    return places


def _bones() -> go.Scatter:
    places = _places()
    x: list[float | None] = []
    y: list[float | None] = []
    for index, name in enumerate(JOINT_NAMES):
        if PARENTS[index] >= 0:
            above = places[JOINT_NAMES[PARENTS[index]]]
            x += [above[0], places[name][0], None]
            y += [above[1], places[name][1], None]
    return go.Scatter(
        x=x,
        y=y,
        mode="lines",
        line={"color": _BONE, "width": 6},
        hoverinfo="skip",
        hovertemplate=None,
        showlegend=False,
        name="body",
    )


def _joints(own: pd.DataFrame, largest: float, latency: float) -> go.Scatter:
    places = _places()
    named = [joint for joint in own.index if joint in places]
    values = [float(own.loc[joint, "mean_deg"]) for joint in named]
    return go.Scatter(
        x=[places[joint][0] for joint in named],
        y=[places[joint][1] for joint in named],
        mode="markers",
        name=f"{latency:g} ms",
        showlegend=False,
        customdata=[
            [joint, value, int(own.loc[joint, "n"])]
            for joint, value in zip(named, values, strict=True)
        ],
        marker={
            "size": [
                _SMALLEST_PX + (_LARGEST_PX - _SMALLEST_PX) * value / largest for value in values
            ],
            "color": values,
            "coloraxis": "coloraxis",
            "opacity": 1.0,
            "line": {"color": "rgba(128, 128, 128, 0.9)", "width": 1},
        },
        hovertemplate=(
            f"%{{customdata[0]}} at {latency:g} ms: %{{customdata[1]:.2f}} deg"
            "<br>n = %{customdata[2]}<extra></extra>"
        ),
    )


def _room(figure: go.Figure, panels: int, largest: float) -> None:
    for column in range(1, panels + 1):
        figure.update_xaxes(visible=False, range=[-1.0, 1.0], constrain="domain", row=1, col=column)
        figure.update_yaxes(
            visible=False,
            range=[-0.1, 1.75],
            scaleanchor=f"x{column if column > 1 else ''}",
            row=1,
            col=column,
        )
    figure.update_layout(
        height=_HEIGHT_PX,
        margin={"b": 20},
        coloraxis={
            "colorscale": "Cividis",
            "cmin": 0.0,
            "cmax": largest,
            "colorbar": {"title": {"text": "mean joint error (deg)", "side": "right"}},
        },
    )
