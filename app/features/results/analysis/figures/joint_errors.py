"""Figures of the mean joint error at each latency, by body part and by joint."""

from typing import Any

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.by_latency import cells
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
    GREEN,
    ORANGE,
    SYMBOLS,
    VERMILLION,
    latency_axis,
    new_figure,
)
from app.protocol import COUNTED_KINDS
from app.science.joint_error import ERROR_JOINTS

_LIMB_PARTS = {
    "arm": ("Shoulder", "UpperArm", "LowerArm", "Hand"),
    "leg": ("UpperLeg", "LowerLeg", "Foot", "Toes"),
}
BODY_PARTS: dict[str, tuple[str, ...]] = {
    "head and neck": ("Neck", "Head"),
    "spine": ("Spine", "Chest", "UpperChest"),
    **{
        f"{side.lower()} {limb}": tuple(f"{side}{part}" for part in parts)
        for limb, parts in _LIMB_PARTS.items()
        for side in ("Left", "Right")
    },
}
"""The joints of each body part; each of ERROR_JOINTS is in exactly one."""
PART_OF_JOINT: dict[str, str] = {
    joint: part for part, joints in BODY_PARTS.items() for joint in joints
}
JOINTS_BY_PART: tuple[str, ...] = tuple(
    joint for joints in BODY_PARTS.values() for joint in joints if joint in ERROR_JOINTS
)
WHAT = (
    "Joint error is the angle between the participant's current pose and the body they saw, "
    "averaged over the active time of hand and foot phases. The hips carry no latency and are left "
    "out."
)
HINGES = (
    "A physics avatar is compared with its hinges' target angles, before their limits; joints "
    "without a hinge are left out."
)
SHIFTED = "Points are shifted sideways to be visible."
INTERVAL = "Points are means over participants with 95 % confidence intervals (t distribution)."
HEAT: dict[str, Any] = {
    "texttemplate": "%{z:.1f}",
    "colorscale": "Cividis",
    "zmin": 0.0,
    "xgap": 1,
    "ygap": 1,
    "colorbar": {"title": {"text": "deg"}},
}
"""The style of heat maps of joint errors."""
_COLOURS = {"head": BLUE, "spine": GREEN, "arm": VERMILLION, "leg": ORANGE}


def joint_error_drawing(errors: pd.DataFrame) -> Drawing:
    """Draw the mean angle by latency and body part, from valid rows of the joint errors."""
    key, title = "joint_error_parts", "Joint error by added latency and body part"
    rows = task_angles(errors)
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(key, title, f"{WHAT} {INTERVAL}", n, "joint errors")
    latencies = sorted(rows["latency_ms"].unique().tolist())
    step = 0.012 * (latencies[-1] - latencies[0])
    figure = new_figure()
    by_part = _by_part(rows)
    for place, part in enumerate(BODY_PARTS):
        if part in by_part:
            # Shift the lines slightly, so that no interval hides another.
            figure.add_trace(_trace(by_part[part], part, place, step * (place - 2.5)))
    latency_axis(figure, latencies)
    figure.update_yaxes(title_text="mean joint error (deg)", rangemode="tozero")
    caption = f"{error_definition(rows)} {INTERVAL} {count_note(n)} {SHIFTED}"
    return drawn(key, title, caption, n, figure, _part_rows(by_part))


def joint_error_map_drawing(errors: pd.DataFrame) -> Drawing:
    """Draw a heat map of the mean angle of every joint at every latency, from valid rows."""
    key, title = "joint_error_joints", "Joint error by added latency and joint"
    rows = task_angles(errors)
    n = participants(rows)
    if n < MIN_PARTICIPANTS:
        return too_few(key, title, WHAT, n, "joint errors")
    each = rows.groupby(["joint", "latency_ms", "participant_code"])["mean_deg"].mean()
    table = each.groupby(level=["joint", "latency_ms"]).mean().unstack("latency_ms")
    joints = [joint for joint in JOINTS_BY_PART if joint in table.index]
    table = table.loc[joints]
    shares = _clipped(rows).reindex(index=table.index, columns=table.columns)
    figure = new_figure()
    figure.add_trace(_heat(table, shares))
    figure.update_xaxes(title_text="joint", tickangle=-40)
    figure.update_yaxes(title_text="added latency (ms)", type="category", autorange="reversed")
    figure.update_layout(height=200 + 44 * len(table.columns))
    caption = f"{error_definition(rows)} {_clipped_note(shares)}{count_note(n)}"
    return drawn(key, title, caption, n, figure, joint_rows(rows))


def _heat(table: pd.DataFrame, shares: pd.DataFrame) -> go.Heatmap:
    """Return a heat map with latencies down, joints across and the value in each cell."""
    numbers = table.T.to_numpy()
    return go.Heatmap(
        x=[str(joint) for joint in table.index],
        y=[f"{latency:g}" for latency in table.columns],
        z=[[None if pd.isna(value) else float(value) for value in row] for row in numbers],
        customdata=[[_clipped_words(share) for share in row] for row in shares.T.to_numpy()],
        hovertemplate="%{x} at %{y} ms: %{z:.2f} deg%{customdata}<extra></extra>",
        **HEAT,
    )


def joint_rows(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the mean over participants by joint and latency, with the number of participants."""
    keys = ["joint", "latency_ms"]
    each = rows.groupby([*keys, "participant_code"])[["mean_deg", "clipped_share"]].mean()
    found = each.groupby(level=keys).agg(
        mean_deg=("mean_deg", "mean"),
        clipped_share=("clipped_share", "mean"),
        n=("mean_deg", "count"),
    )
    return found.reset_index()


def _part_rows(by_part: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Return mean and interval over participants by body part and latency."""
    found = []
    for part, own in by_part.items():
        for latency, cell in cells(own).items():
            half = cell.half_width
            ends = (None, None) if half is None else (cell.mean - half, cell.mean + half)
            found.append((part, latency, cell.mean, *ends, cell.n))
    names = ("body_part", "latency_ms", "mean_deg", "ci95_low_deg", "ci95_high_deg", "n")
    return pd.DataFrame(found, columns=list(names))


def error_definition(rows: pd.DataFrame) -> str:
    """Return the definition of joint error that applies to the avatars of these rows."""
    return f"{WHAT} {HINGES}" if rows["clipped_share"].notna().any() else WHAT


def _clipped(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the share of clipped samples by joint and latency, NaN where it is unknown.

    It is a mean over participants.
    """
    each = rows.groupby(["joint", "latency_ms", "participant_code"])["clipped_share"].mean()
    return each.groupby(level=["joint", "latency_ms"]).mean().unstack("latency_ms")


def _clipped_words(share: float) -> str:
    return "" if pd.isna(share) else f"<br>clipped in {100.0 * share:.1f} % of samples"


def _clipped_note(shares: pd.DataFrame) -> str:
    """Return a sentence on the mean share of clipped samples and the joint with the largest.

    It is empty for bodies without limits.
    """
    by_joint = shares.mean(axis=1).dropna()
    if by_joint.empty:
        return ""
    most_clipped = str(by_joint.idxmax())
    return (
        "On average the target of a joint exceeded its limits (clipped) in "
        f"{100.0 * by_joint.mean():.1f} % of the samples, {most_clipped} most often "
        f"({100.0 * by_joint[most_clipped]:.1f} %). "
    )


def task_angles(errors: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of task phases with the whole angle, relative to the present pose.

    Fingers are left out, so that means over joints are comparable with and without them.
    """
    chosen = errors["axis"].eq("angle") & errors["reference"].eq("present")
    chosen &= errors["joint"].isin(ERROR_JOINTS)
    return errors[chosen & errors["phase_kind"].isin(COUNTED_KINDS)].dropna(subset=["mean_deg"])


def _by_part(rows: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Return the means of every body part with joints in these rows, ordered as BODY_PARTS."""
    groups = dict(iter(rows.groupby(rows["joint"].map(PART_OF_JOINT))))
    return {part: _means(groups[part]) for part in BODY_PARTS if part in groups}


def _means(rows: pd.DataFrame) -> pd.DataFrame:
    """Return one value per participant and latency: the mean over joints and phases."""
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
