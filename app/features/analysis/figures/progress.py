"""How far the study has come, order by order."""

from collections.abc import Sequence

import pandas as pd
import plotly.graph_objects as go

from app.features.analysis.figures.drawing import Drawing, drawn, participants
from app.features.analysis.figures.theme import BLUE, ORANGE, VERMILLION, new_figure

FEW = 10
KEY, TITLE = "progress", "Sessions by order of latencies"
_STATES = {
    "completed": (("completed",), BLUE, ""),
    "open": (("planned", "active"), ORANGE, "/"),
    "withdrawn or aborted": (("withdrawn", "aborted"), VERMILLION, "x"),
}


def progress_drawing(
    sessions: pd.DataFrame, orders: Sequence[str], *, blinded: bool = False
) -> Drawing:
    """From all rows of the table of sessions; `orders` are those of the design ("0 125 350").

    `blinded` puts all orders together: the order of an open session is not the reader's to know.
    """
    n = participants(sessions)
    if sessions.empty:
        return Drawing(KEY, TITLE, "", 0, empty="No session has joined the study yet.")
    own = pd.Series("all orders", sessions.index) if blinded else sessions["order"]
    names = ["all orders"] if blinded else sorted({*orders, *own}, key=_as_numbers)
    figure = new_figure()
    for state, (statuses, colour, pattern) in _STATES.items():
        counts = own[sessions["status"].isin(statuses)].value_counts()
        figure.add_trace(
            go.Bar(
                x=[name.replace(" ", " → ") if not blinded else name for name in names],
                y=[int(counts.get(name, 0)) for name in names],
                name=state,
                marker={"color": colour, "pattern": {"shape": pattern}},
                hovertemplate=f"%{{x}} ms: %{{y}} {state}<extra></extra>",
            )
        )
    figure.update_layout(barmode="stack")
    figure.update_xaxes(title_text="order of added latencies (ms)", type="category")
    figure.update_yaxes(title_text="sessions (count)", rangemode="tozero")
    if own.value_counts().max() <= FEW:
        # Left alone, plotly would label halves of sessions.
        figure.update_yaxes(dtick=1)
    caption = f"n = {n} participant{'s' if n != 1 else ''}. Balance counts completed sessions only."
    if blinded:
        caption += " The study is blinded, so orders are not told apart."
    return drawn(KEY, TITLE, caption, n, figure)


def _as_numbers(order: str) -> tuple[float, ...]:
    return tuple(float(part) for part in order.split())
