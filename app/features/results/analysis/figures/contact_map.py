"""The heat map of contact time by side of the box and body part."""

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.by_latency import LIMBS
from app.features.results.analysis.figures.contacts import mean_times, part_side_times
from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    limb_note,
    participants,
    too_few,
)
from app.features.results.analysis.figures.fingers import by_finger, fingers_note
from app.features.results.analysis.figures.theme import new_figure
from app.protocol import COUNTED_KINDS

KEY, TITLE = "contacts_map", "Contact time by side of the box and body part"
WHAT = (
    "Mean active seconds per phase over participants in which a body part touched a side, summed "
    "over boxes; a phase without a contact counts as 0. Parts that touch together both count, so "
    "rows must not be summed to the time a side was red. Each cell shows its value."
)
_ROW_PX, _FOOT_PX, _LEAST_PX = 26, 210, 360
_APART = "\u001f"


def contact_map_drawing(phases: pd.DataFrame, contacts: pd.DataFrame) -> Drawing:
    """Draw contact times from valid rows of phases and contacts, by limb and latency.

    The phases say whether their fingers were recorded (`mark_fingers`).
    """
    tasks = phases[phases["phase_kind"].isin(COUNTED_KINDS)]
    sides = contacts[contacts["surface_kind"] == "side"]
    n = participants(tasks)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, WHAT, n, "a finished hand or foot phase").of_group("tasks")
    if sides.empty:
        empty = "No side of a box was touched in any valid phase."
        return Drawing(KEY, TITLE, WHAT, n, empty=empty, group="tasks", wide=True)
    means = _means(tasks, sides)
    figure = _figure(means)
    caption = f"{WHAT} {count_note(n)} {fingers_note(tasks)} {limb_note(tasks)}"
    return drawn(KEY, TITLE, caption, n, figure, means.dropna()).of_group("tasks", wide=True)


def _means(tasks: pd.DataFrame, sides: pd.DataFrame) -> pd.DataFrame:
    """Return limb, latency_ms, body_part, side, mean_s_per_phase, n, for existing combinations.

    The mean is not a number, and n is 0, where the part was not known at that latency.
    """
    times = part_side_times(by_finger(sides, tasks))
    times["what"] = times["body_part"] + _APART + times["side"]
    found = []
    for limb in [limb for limb in LIMBS if (tasks["limb"] == limb).any()]:
        own = mean_times(tasks[tasks["limb"] == limb], times)
        for latency, what, mean_s, n in own.cells():
            part, _, side = what.partition(_APART)
            found.append((limb, latency, part, side, mean_s, n))
    names = ("limb", "latency_ms", "body_part", "side", "mean_s_per_phase", "n")
    return pd.DataFrame(found, columns=list(names))


def _figure(means: pd.DataFrame) -> go.Figure:
    limbs = [limb for limb in LIMBS if (means["limb"] == limb).any()]
    latencies = sorted(means["latency_ms"].unique().tolist())
    figure = new_figure(
        rows=len(limbs),
        titles=tuple(
            f"{limb.capitalize()}, {latency:g} ms" for limb in limbs for latency in latencies
        ),
        horizontal_spacing=0.03,
        vertical_spacing=0.2,
        shared_yaxes=True,
    )
    height = 0
    for row, limb in enumerate(limbs, start=1):
        own = means[means["limb"] == limb]
        sides, parts = sorted(own["side"].unique()), sorted(own["body_part"].unique())
        height += max(_ROW_PX * len(parts), 110)
        for column, latency in enumerate(latencies, start=1):
            at = own[own["latency_ms"] == latency]
            cell = at.pivot(index="body_part", columns="side", values="mean_s_per_phase")
            cell = cell.reindex(index=parts, columns=sides).fillna(0.0)
            cell.loc[sorted(set(at[at["n"] == 0]["body_part"]))] = float("nan")
            figure.add_trace(_heat(cell), row=row, col=column)
            figure.update_xaxes(type="category", row=row, col=column)
            if row == len(limbs):
                figure.update_xaxes(title_text="side of the box", row=row, col=column)
        figure.update_yaxes(title_text="body part", autorange="reversed", row=row, col=1)
    figure.update_layout(
        height=max(height + _FOOT_PX, _LEAST_PX),
        margin={"b": 56},
        coloraxis={
            "colorscale": "Cividis",
            "cmin": 0.0,
            # plotly ignores the lower bound unless the upper one is set, too.
            "cmax": float(means["mean_s_per_phase"].max()) or 1.0,
            "colorbar": {"title": {"text": "time (s per phase)", "side": "right"}},
        },
    )
    return figure


def _heat(cell: pd.DataFrame) -> go.Heatmap:
    numbers = [
        [None if pd.isna(value) else float(value) for value in row] for row in cell.to_numpy()
    ]
    return go.Heatmap(
        x=[str(side) for side in cell.columns],
        y=[str(part) for part in cell.index],
        z=numbers,
        coloraxis="coloraxis",
        texttemplate="%{z:.2f}",
        xgap=1,
        ygap=1,
        hovertemplate="%{y} at %{x}: %{z:.2f} s per phase<extra></extra>",
    )
