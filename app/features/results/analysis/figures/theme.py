"""The common look of all figures, legible with any colour vision and on any background.

Colours are Okabe and Ito's (2008) without black and yellow, which would vanish on a dark or on a
light background. Whatever a colour shows is also shown by a shape, a dash or a pattern.
"""

import copy
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
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
CACHED_FIGURES = 64
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
    """Return an empty figure in the common look with a panel per title, in `rows` rows."""
    # Copying takes a seventh of the time, and a page has few different panel layouts.
    return copy.deepcopy(_empty_figure(rows, titles, **options))


@lru_cache(maxsize=CACHED_FIGURES)
def _empty_figure(rows: int, titles: tuple[str, ...], **options: object) -> go.Figure:
    figure = make_subplots(
        rows=rows,
        cols=len(titles) // rows,
        subplot_titles=titles if any(titles) else None,
        **options,
    )
    # The legend is below the plot because the panel titles are above it.
    figure.update_layout(
        template=TEMPLATE,
        legend={"orientation": "h", "x": 0.0, "y": -0.3, "yanchor": "top"},
        margin={"t": 36 if any(titles) else 16, "b": 84},
    )
    return figure


def hatched(colour: str, pattern: str) -> dict[str, object]:
    """Return the look of a bar: colour, edge, and a pattern that distinguishes it in greyscale."""
    return {
        "color": colour,
        "pattern": {"shape": pattern},
        "line": {"color": colour, "width": 1.2},
    }


def quiet(lines: int) -> str:
    """Return the grey for a number of overlapping lines: the more lines, the fainter."""
    return f"rgba(128, 128, 128, {max(0.06, min(0.55, 12.0 / max(lines, 1))):.2f})"


def see_through(colour: str) -> str:
    """Return a transparent version of a colour "#rrggbb" for areas that overlap."""
    red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
    return f"rgba({red}, {green}, {blue}, 0.18)"


def latency_line(latency_ms: float, place: int, *, size_px: int) -> dict[str, object]:
    """Return the look of the line of the latency at index `place`: its colour, dash and symbol."""
    colour = COLOURS[place % len(COLOURS)]
    return {
        "mode": "lines+markers",
        "name": f"{latency_ms:g} ms",
        "legendgroup": f"{latency_ms:g}",
        "line": {"color": colour, "width": 2, "dash": DASHES[place % len(DASHES)]},
        "marker": {"color": colour, "size": size_px, "symbol": SYMBOLS[place % len(SYMBOLS)]},
    }


@dataclass(frozen=True)
class LineEnd:
    """The last point of a line, its label and its colour."""

    x: float
    y: float
    text: str
    colour: str


NO_LEGEND_PX = 46
"""Below a plot whose lines are labelled where they are."""
PLOT_PX = 240.0
"""About the height of a plot, to tell which labels would cover each other."""
LABEL_PX = 15.0


def label_line_ends(figure: go.Figure, ends: Sequence[LineEnd], *, top: float, column: int) -> None:
    """Write each line's name at its right end instead of in a legend.

    `top`: the highest value of the panel, whose axis begins at 0. Labels that would cover each
    other are moved apart, and stay in the order of their lines.
    """
    below_px = -math.inf
    for end in sorted(ends, key=lambda one: one.y):
        own_px = PLOT_PX * end.y / top if top > 0.0 else 0.0
        at_px = max(own_px, below_px + LABEL_PX)
        below_px = at_px
        figure.add_annotation(
            x=end.x,
            y=end.y,
            text=end.text,
            showarrow=False,
            xanchor="left",
            xshift=7,
            yshift=at_px - own_px,
            font={"color": end.colour, "size": 12},
            row=1,
            col=column,
        )


def latency_axis(figure: go.Figure, latencies_ms: list[float]) -> None:
    """Label the x axes with the study's latencies, with a margin at both ends.

    The right one has room for the shape beside the last latency, as wide as the gaps allow.
    """
    room = 0.08 * (latencies_ms[-1] - latencies_ms[0]) or 10.0
    gap = min((b - a for a, b in itertools.pairwise(latencies_ms)), default=0.0)
    beyond = max(1.6 * room, 0.25 * gap)
    figure.update_xaxes(
        title_text="added latency (ms)",
        tickvals=latencies_ms,
        ticktext=[f"{latency:g}" for latency in latencies_ms],
        range=[latencies_ms[0] - room, latencies_ms[-1] + beyond],
        zeroline=False,
    )
