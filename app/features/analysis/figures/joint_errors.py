"""How far the body was from the participant's pose, at each latency."""

import pandas as pd
import plotly.graph_objects as go

from app.features.analysis.figures.body_parts import BODY_PARTS, JOINTS_BY_PART, PART_OF_JOINT
from app.features.analysis.figures.by_latency import cells
from app.features.analysis.figures.drawing import (
    FEWEST_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    participants,
    too_few,
)
from app.features.analysis.figures.theme import (
    BLUE,
    GREEN,
    ORANGE,
    SYMBOLS,
    VERMILLION,
    latency_axis,
    new_figure,
)

WHAT = (
    "Joint error is the angle between the participant's pose at the moment and the body they saw, "
    "averaged over the active time of hand and foot phases. The hips carry no latency and are left "
    "out."
)
INTERVAL = "Points are means over participants with 95 % confidence intervals (t distribution)."
_COLOURS = {"head": BLUE, "spine": GREEN, "arm": VERMILLION, "leg": ORANGE}


def joint_error_drawing(errors: pd.DataFrame) -> Drawing:
    """Mean angle by latency and part of the body, from valid rows of the table of joint errors."""
    key, title = "joint_error_parts", "Joint error by added latency and body part"
    rows = _angles(errors)
    n = participants(rows)
    if n < FEWEST_PARTICIPANTS:
        return too_few(key, title, f"{WHAT} {INTERVAL}", n, "joint errors")
    latencies = sorted(rows["latency_ms"].unique().tolist())
    step = 0.012 * (latencies[-1] - latencies[0])
    figure = new_figure()
    for place, part in enumerate(BODY_PARTS):
        own = _means(rows[rows["joint"].map(PART_OF_JOINT) == part])
        if len(own):
            # A little apart, so that no interval hides another.
            figure.add_trace(_trace(own, part, place, step * (place - 2.5)))
    latency_axis(figure, latencies)
    figure.update_yaxes(title_text="mean joint error (deg)", rangemode="tozero")
    caption = f"{WHAT} {INTERVAL} {count_note(n)} Points stand a little apart to be seen."
    return drawn(key, title, caption, n, figure)


def joint_error_map_drawing(errors: pd.DataFrame) -> Drawing:
    """Mean angle of every joint at every latency, from the same rows."""
    key, title = "joint_error_joints", "Joint error by added latency and joint"
    rows = _angles(errors)
    n = participants(rows)
    if n < FEWEST_PARTICIPANTS:
        return too_few(key, title, WHAT, n, "joint errors")
    each = rows.groupby(["joint", "latency_ms", "participant_code"])["mean_deg"].mean()
    table = each.groupby(level=["joint", "latency_ms"]).mean().unstack("latency_ms")
    joints = [joint for joint in JOINTS_BY_PART if joint in table.index]
    table = table.loc[joints]
    figure = new_figure()
    figure.add_trace(
        go.Heatmap(
            x=[f"{latency:g}" for latency in table.columns],
            y=joints,
            z=[[None if pd.isna(value) else value for value in row] for row in table.to_numpy()],
            colorscale="Cividis",
            colorbar={"title": {"text": "deg"}},
            hovertemplate="%{y} at %{x} ms: %{z:.2f} deg<extra></extra>",
        )
    )
    figure.update_xaxes(title_text="added latency (ms)", type="category")
    figure.update_yaxes(title_text="joint", title_standoff=24, autorange="reversed")
    figure.update_layout(height=620)
    return drawn(key, title, f"{WHAT} {count_note(n)}", n, figure)


def _angles(errors: pd.DataFrame) -> pd.DataFrame:
    """Whole angles against the present pose, of the tasks."""
    chosen = errors["axis"].eq("angle") & errors["reference"].eq("present")
    return errors[chosen & errors["phase_kind"].eq("task")].dropna(subset=["mean_deg"])


def _means(rows: pd.DataFrame) -> pd.DataFrame:
    """One value per participant and latency: the mean over joints and phases."""
    means = rows.groupby(["participant_code", "latency_ms"])["mean_deg"].mean()
    return means.rename("value").reset_index()


def _trace(own: pd.DataFrame, part: str, place: int, shift_ms: float) -> go.Scatter:
    means = cells(own)
    colour = next(colour for word, colour in _COLOURS.items() if word in part)
    return go.Scatter(
        x=[latency + shift_ms for latency in means],
        y=[cell.mean for cell in means.values()],
        error_y={
            "type": "data",
            "array": [cell.half_width for cell in means.values()],
            "color": colour,
        },
        customdata=[[at, cell.n, cell.words("deg")] for at, cell in means.items()],
        mode="lines+markers",
        name=part,
        line={"color": colour, "width": 2, "dash": "dash" if part.startswith("right") else "solid"},
        marker={"color": colour, "size": 9, "symbol": SYMBOLS[place]},
        hovertemplate=(
            f"{part}: mean %{{y:.2f}} %{{customdata[2]}} at %{{customdata[0]:g}} ms"
            "<br>n = %{customdata[1]}<extra></extra>"
        ),
    )
