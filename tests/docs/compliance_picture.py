"""Draw how a pushed shin gives way and comes back, for the page on the avatar.

`python -m tests.docs.compliance_picture docs/images/compliance.png` makes the pushes of
`./run bench compliance --only push` and draws the deflection over time: one panel for each
stiffness, and one for the push from the side.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from app.science.avatar.configuration import Compliance
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import RETURNED_RAD, Response
from app.science.rotations import Vector
from tests.benchmarks.compliance import PUSHES, STIFFNESSES, TARGETS, pushed, pushed_shin
from tests.support.browser import launched_browser

WIDTH_PX, HEIGHT_PX = 1180, 430
SHOWN_S = 0.9
PUSHED_S = 0.2
DASHES = {"joint": "solid", "world": "dash"}
# Okabe and Ito (2008), told apart also with a colour vision deficiency.
COLOURS = ("#56b4e9", "#e69f00", "#0072b2")
FRONT, SIDE = PUSHES[:3], PUSHES[3]


@dataclass(frozen=True)
class Curve:
    """One push: the panel (from 1) where its curve is drawn, and how."""

    panel: int
    name: str
    colour: str
    force_n: float
    direction: Vector
    stiffness: float


def curves() -> list[Curve]:
    """Return the pushes from the front by stiffness, and those from the side in a last panel."""
    front = [
        Curve(panel, name, colour, force_n, direction, stiffness)
        for panel, stiffness in enumerate(STIFFNESSES, start=1)
        for (name, force_n, direction), colour in zip(FRONT, COLOURS, strict=True)
    ]
    _, force_n, direction = SIDE
    side = [
        Curve(4, f"{100 * stiffness:g} %", colour, force_n, direction, stiffness)
        for stiffness, colour in zip(STIFFNESSES, COLOURS, strict=True)
    ]
    return [*front, *side]


def drawn() -> go.Figure:
    """Make every push with joint and with world targets, and draw the deflections in degrees."""
    front = [f"from the front, {100 * one:g} % of the stiffness" for one in STIFFNESSES]
    figure = make_subplots(cols=4, subplot_titles=[*front, "200 N from the side"])
    figure.update_layout(
        template="plotly_white",
        font={"size": 13},
        legend={"orientation": "h", "y": -0.2, "x": 0.5, "xanchor": "center"},
        margin={"l": 55, "r": 10, "t": 40, "b": 100},
    )
    figure.update_annotations(font_size=14)
    figure.update_xaxes(title="s since the push began", range=[0, SHOWN_S], dtick=0.2)
    figure.update_yaxes(rangemode="tozero")
    figure.update_yaxes(title="the shin has turned by, °", title_standoff=4, col=1)
    for curve in curves():
        push = pushed_shin(curve.force_n, curve.direction)
        for targets in TARGETS:
            leg = Compliance(curve.stiffness, targets)
            response = pushed(default_configuration(), None, leg, push)
            add_curve(figure, curve, targets, response)
    within_deg = float(np.degrees(RETURNED_RAD))
    figure.add_hline(within_deg, line={"width": 1, "color": "#777777", "dash": "dot"})
    figure.add_vrect(0, PUSHED_S, fillcolor="#888888", opacity=0.15, line_width=0)
    return figure


def add_curve(figure: go.Figure, curve: Curve, targets: str, response: Response) -> None:
    """Add the deflection of one push to its panel."""
    figure.add_scatter(
        x=[0.0, *response.times_s],
        y=[0.0, *np.degrees(response.deflection_rad)],
        name=f"{curve.name}, {targets} targets",
        line={"color": curve.colour, "dash": DASHES[targets], "width": 2},
        # The same three lines stand in each panel from the front.
        showlegend=curve.panel in (1, 4),
        legendgroup=curve.name,
        row=1,
        col=curve.panel,
    )


def main(file: Path) -> None:
    """Write the picture as PNG."""
    html = drawn().to_html(include_plotlyjs=True, config={"staticPlot": True})
    with launched_browser() as browser:
        page = browser.new_page(viewport={"width": WIDTH_PX, "height": HEIGHT_PX})
        page.set_content(html)
        page.locator(".main-svg").first.wait_for()
        page.screenshot(path=file)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
