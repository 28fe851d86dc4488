"""Figures of the study's progress: sessions by order, and completed sessions over time."""

from collections.abc import Sequence

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.drawing import Drawing, drawn, participants
from app.features.results.analysis.figures.theme import (
    BLUE,
    ORANGE,
    PURPLE,
    VERMILLION,
    hatched,
    new_figure,
)

FEW = 10
KEY, TITLE = "progress", "Sessions by order of latencies"
TIME_KEY, TIME_TITLE = "progress_time", "Completed sessions over time"
NOT_VALID = "completed, not valid"
_STATES = {
    "completed": (("completed",), BLUE, ""),
    NOT_VALID: ((NOT_VALID,), PURPLE, "."),
    "open": (("planned", "active"), ORANGE, "/"),
    "withdrawn or aborted": (("withdrawn", "aborted"), VERMILLION, "x"),
}


def progress_drawing(
    sessions: pd.DataFrame, orders: Sequence[str], *, blinded: bool = False
) -> Drawing:
    """Draw the number of sessions by order and status, from all rows of the table of sessions.

    `orders` are those of the design: latencies ("0 125 350"), or the keys of conditions if some
    share latencies. `blinded` merges all orders, because the order of an open session must not be
    revealed.
    """
    n = participants(sessions)
    if sessions.empty:
        return Drawing(KEY, TITLE, "", 0, empty="No session has been created yet.")
    own = pd.Series("all orders", sessions.index) if blinded else sessions["order"]
    status = _statuses(sessions)
    names = (
        ["all orders"]
        if blinded
        else sorted({*orders, *own}, key=lambda name: (_latencies_ms(name), name))
    )
    in_ms = not blinded and all(map(_latencies_ms, names))
    shown = names if blinded else [name.replace(" ", " → ") for name in names]
    figure = new_figure()
    for state, (statuses, colour, pattern) in _STATES.items():
        counts = own[status.isin(statuses)].value_counts()
        if state == NOT_VALID and counts.empty:
            continue
        figure.add_trace(
            go.Bar(
                x=shown,
                # Bars of height 0 would still draw their edges.
                y=[int(counts.get(name, 0)) or None for name in names],
                name=state,
                marker=hatched(colour, pattern),
                hovertemplate=f"%{{x}}{' ms' if in_ms else ''}: %{{y}} {state}<extra></extra>",
            )
        )
    figure.update_layout(barmode="stack")
    axis = "order of added latencies (ms)" if in_ms else "order of conditions"
    # In one line the orders of neighbouring bars would run into each other.
    labels = [name.replace(" → ", " →<br>") for name in shown]
    figure.update_xaxes(title_text=axis, type="category", tickvals=shown, ticktext=labels)
    figure.update_yaxes(title_text="sessions (count)", rangemode="tozero")
    if own.value_counts().max() <= FEW:
        # By default, plotly would label fractions of sessions.
        figure.update_yaxes(dtick=1)
    caption = f"n = {n} participant{'s' if n != 1 else ''}. Balance counts completed sessions only."
    if (status == NOT_VALID).any():
        caption = caption.replace("completed sessions only", "completed sessions that are valid")
    if blinded:
        caption += " The study is blinded, so orders are not shown separately."
    table = own.rename("order").to_frame().assign(status=status)
    keys = ["order", "status"]
    rows = table.groupby(keys).size().rename("sessions").reset_index().sort_values(keys)
    return drawn(KEY, TITLE, caption, n, figure, rows)


def _statuses(sessions: pd.DataFrame) -> "pd.Series[str]":
    """Return the status of each session; completed but invalid sessions get a separate status."""
    off = (sessions["status"] == "completed") & ~sessions["valid"]
    return sessions["status"].mask(off, NOT_VALID)


def progress_time_drawing(sessions: pd.DataFrame, planned: int) -> Drawing:
    """Draw completed sessions by day, and the number that the design asks for (`planned`)."""
    done = sessions[_statuses(sessions) == "completed"].dropna(subset=["ended_at_utc"])
    n = participants(done)
    if done.empty:
        return Drawing(
            TIME_KEY, TIME_TITLE, "", 0, empty="No valid session has been completed yet."
        )
    days = done["ended_at_utc"].dt.date.value_counts().sort_index()
    rows = days.rename_axis("day_utc").rename("completed").reset_index()
    rows["together"] = rows["completed"].cumsum()
    x = [day.isoformat() for day in rows["day_utc"]]
    figure = new_figure()
    figure.add_trace(
        go.Scatter(
            x=x,
            y=rows["together"].tolist(),
            mode="lines+markers",
            name="completed",
            line={"color": BLUE, "width": 3, "shape": "hv"},
            marker={"symbol": "circle", "size": 8},
            hovertemplate="%{x}: %{y} completed<extra></extra>",
        )
    )
    figure.add_trace(
        go.Scatter(
            x=[x[0], x[-1]],
            y=[planned, planned],
            mode="lines+markers",
            name="planned",
            line={"color": VERMILLION, "width": 2, "dash": "dash"},
            marker={"symbol": "square-open", "size": 7},
            hovertemplate=f"{planned} planned<extra></extra>",
        )
    )
    figure.update_xaxes(title_text="day (UTC)", type="category" if len(x) <= FEW else "date")
    figure.update_yaxes(title_text="sessions (count)", rangemode="tozero")
    caption = f"Cumulative number of completed sessions, of {planned} in the design. n = {n}."
    return drawn(TIME_KEY, TIME_TITLE, caption, n, figure, rows)


def _latencies_ms(order: str) -> tuple[float, ...]:
    """Return the latencies of an order; none if it names conditions that share latencies."""
    try:
        return tuple(float(part) for part in order.split())
    except ValueError:
        return ()
