"""Determine what to display of a task's state: the goal, the colours and the numbers."""

from enum import StrEnum

from app.science.tasks.names import SurfaceKind
from app.science.tasks.state import TaskState


class Colour(StrEnum):
    """The four colours that a surface can have; a palette determines how each looks."""

    GREY = "grey"
    GREEN = "green"
    WHITE = "white"
    RED = "red"


def current_goal(state: TaskState) -> str | None:
    """Return the key of the surface to touch next: a panel, the target, or the start square.

    The start square is the goal of a walk back. Before the start the goal is the first panel, and
    in a pause it is the goal that will be current when the phase resumes; None once frozen.
    """
    layout = state.rules.layout
    if state.frozen:
        return None
    if state.walk_back_since_s is not None:
        return layout.start_key
    if state.n_green < len(state.order):
        return layout.panel_key(state.order[state.n_green])
    return layout.target_key


def surface_state(state: TaskState) -> dict[str, Colour]:
    """Return the colour of every surface.

    Panels are grey or green, sides white or red, the target green, the start square white. Sides
    are white while the clock is stopped: colours show what is being counted.
    """
    layout, red = state.rules.layout, state.red_units()
    green = {layout.panel_key(box) for box in state.order[: state.n_green]}
    fixed = {SurfaceKind.TARGET: Colour.GREEN, SurfaceKind.START: Colour.WHITE}
    colours: dict[str, Colour] = {}
    for surface in layout.surfaces:
        if surface.kind is SurfaceKind.PANEL:
            colours[surface.key] = Colour.GREEN if surface.key in green else Colour.GREY
        elif surface.kind is SurfaceKind.SIDE:
            colours[surface.key] = Colour.RED if surface.unit in red else Colour.WHITE
        else:
            colours[surface.key] = fixed[surface.kind]
    return colours


def displayed_numbers(state: TaskState) -> dict[int, int]:
    """Return the number shown at each box: its place in the current order, starting at 1."""
    return {box: place for place, box in enumerate(state.order, start=1)}
