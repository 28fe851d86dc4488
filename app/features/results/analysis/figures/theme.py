"""One look for all figures: colours that every kind of vision tells apart, on any background.

Colours are Okabe and Ito's (2008) without black and yellow, which one background or the other would
swallow. Whatever a colour tells, a shape, a dash or a pattern tells too.
"""

import copy
from functools import lru_cache

import plotly.graph_objects as go
from plotly.subplots import make_subplots

BLUE, VERMILLION, GREEN = "#0072B2", "#D55E00", "#009E73"
ORANGE, PURPLE, SKY = "#E69F00", "#CC79A7", "#56B4E9"
COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY)
QUIET = "rgba(128, 128, 128, 0.55)"
CALM = "rgba(128, 128, 128, 0.18)"
SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x", "star")
PATTERNS = ("", "/", "x", "-", ".", "+")
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
KEPT_FIGURES = 64
_CLEAR = "rgba(0, 0, 0, 0)"
_LINES = "rgba(128, 128, 128, 0.3)"

_AXIS = go.layout.XAxis(gridcolor=_LINES, zerolinecolor=_LINES, automargin=True, title_standoff=8)
TEMPLATE = go.layout.Template(
    layout=go.Layout(
        paper_bgcolor=_CLEAR,
        plot_bgcolor=_CLEAR,
        colorway=COLOURS,
        xaxis=_AXIS,
        yaxis=_AXIS.to_plotly_json(),
        margin={"l": 60, "r": 20, "t": 60, "b": 60},
        hovermode="closest",
    )
)


def new_figure(*, rows: int = 1, titles: tuple[str, ...] = ("",), **options: object) -> go.Figure:
    """An empty figure in our look with a panel for each title, `rows` rows of them."""
    # A copy takes a seventh of the time, and a page of figures has few kinds of panels.
    return copy.deepcopy(_empty_figure(rows, titles, **options))


@lru_cache(maxsize=KEPT_FIGURES)
def _empty_figure(rows: int, titles: tuple[str, ...], **options: object) -> go.Figure:
    figure = make_subplots(
        rows=rows,
        cols=len(titles) // rows,
        subplot_titles=titles if any(titles) else None,
        **options,
    )
    # The legend stands below the plot: above it are the titles of the panels.
    figure.update_layout(
        template=TEMPLATE,
        legend={"orientation": "h", "x": 0.0, "y": -0.3, "yanchor": "top"},
        margin={"t": 36 if any(titles) else 16, "b": 84},
    )
    return figure


def hatched(colour: str, pattern: str) -> dict[str, object]:
    """How a bar looks: its colour, a pattern that tells it apart without, and an edge."""
    return {
        "color": colour,
        "pattern": {"shape": pattern},
        "line": {"color": colour, "width": 1.2},
    }


def quiet(lines: int) -> str:
    """The grey of so many lines over each other: the more, the fainter each."""
    return f"rgba(128, 128, 128, {max(0.06, min(0.55, 12.0 / max(lines, 1))):.2f})"


def see_through(colour: str) -> str:
    """A colour "#rrggbb" for areas that lie over each other."""
    red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
    return f"rgba({red}, {green}, {blue}, 0.18)"


def latency_line(latency_ms: float, place: int, *, size_px: int) -> dict[str, object]:
    """How the line of the latency at this place is drawn: known by colour, dash and shape."""
    colour = COLOURS[place % len(COLOURS)]
    return {
        "mode": "lines+markers",
        "name": f"{latency_ms:g} ms",
        "legendgroup": f"{latency_ms:g}",
        "line": {"color": colour, "width": 2, "dash": DASHES[place % len(DASHES)]},
        "marker": {"color": colour, "size": size_px, "symbol": SYMBOLS[place % len(SYMBOLS)]},
    }


def latency_axis(figure: go.Figure, latencies_ms: list[float]) -> None:
    """Label the x axes with the study's latencies, a little room at both ends."""
    room = 0.08 * (latencies_ms[-1] - latencies_ms[0]) or 10.0
    figure.update_xaxes(
        title_text="added latency (ms)",
        tickvals=latencies_ms,
        ticktext=[f"{latency:g}" for latency in latencies_ms],
        range=[latencies_ms[0] - room, latencies_ms[-1] + 1.6 * room],
        zeroline=False,
    )
