"""What partners tell each other: the states of persons and cars on the floor.

The floor is seen from above, as in `app.science.walking`: x to the right, y ahead, angles
counter-clockwise from x. Metres, seconds, radians.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, hypot, isfinite, pi, remainder, sin
from typing import Literal

ActorKind = Literal["person", "car"]
_STRAIGHT_RAD_S = 1e-6
"""Below this turn rate the arc is a line; the formula for arcs would divide by it."""


class CosimulationError(ValueError):
    """A scene, a partner or what it said is invalid; the message says what and what to do."""


@dataclass(frozen=True)
class State:
    """One actor at one time.

    Attributes:
        name: the actor; no two actors of a scene have the same.
        kind: person or car.
        time_s: scene time.
        x_m, y_m: the middle of its outline.
        heading_rad: direction it faces, counter-clockwise from x.
        speed_m_s: along the heading.
        turn_rad_s: rate of change of the heading.
        length_m, width_m: outline, along and across the heading.
    """

    name: str
    kind: ActorKind
    time_s: float
    x_m: float
    y_m: float
    heading_rad: float
    speed_m_s: float
    turn_rad_s: float
    length_m: float
    width_m: float

    def __post_init__(self) -> None:
        """Raise CosimulationError unless all numbers are finite and the outline has a size."""
        numbers = (
            *(self.time_s, self.x_m, self.y_m, self.heading_rad, self.speed_m_s),
            *(self.turn_rad_s, self.length_m, self.width_m),
        )
        # A sum of finite numbers is finite unless they are absurd, and these would be absurd.
        # (`fsum` would raise an error of its own.)
        if not isfinite(sum(numbers)):
            raise CosimulationError(f"The state of {self.name!r} at {self.time_s} s is not finite.")
        if not (self.length_m > 0.0 and self.width_m > 0.0):
            raise CosimulationError(
                f"{self.name!r} is {self.length_m} x {self.width_m} m; both must be positive."
            )


def extrapolated(state: State, time_s: float) -> State:
    """Return where an actor is at a later time if it keeps its speed and its turn rate.

    Source: the model of constant turn rate and velocity; Schubert, Richter and Wanielik (2008),
    "Comparison and evaluation of advanced motion models for vehicle tracking".
    """
    dt_s = time_s - state.time_s
    speed, turn, heading = state.speed_m_s, state.turn_rad_s, state.heading_rad
    if abs(turn) < _STRAIGHT_RAD_S:
        dx_m, dy_m = speed * dt_s * cos(heading), speed * dt_s * sin(heading)
    else:
        later = heading + turn * dt_s
        dx_m = speed / turn * (sin(later) - sin(heading))
        dy_m = speed / turn * (cos(heading) - cos(later))
    return replace(
        state,
        time_s=time_s,
        x_m=state.x_m + dx_m,
        y_m=state.y_m + dy_m,
        heading_rad=remainder(heading + turn * dt_s, 2.0 * pi),
    )


def interpolated(earlier: State, later: State, time_s: float) -> State:
    """Return an actor's state between two that its partner computed; headings the short way."""
    share = (time_s - earlier.time_s) / (later.time_s - earlier.time_s)
    turned = remainder(later.heading_rad - earlier.heading_rad, 2.0 * pi)

    def between(start: float, end: float) -> float:
        return start + share * (end - start)

    return replace(
        earlier,
        time_s=time_s,
        x_m=between(earlier.x_m, later.x_m),
        y_m=between(earlier.y_m, later.y_m),
        heading_rad=remainder(earlier.heading_rad + share * turned, 2.0 * pi),
        speed_m_s=between(earlier.speed_m_s, later.speed_m_s),
        turn_rad_s=between(earlier.turn_rad_s, later.turn_rad_s),
    )


def distance_m(one: State, other: State) -> float:
    """Return the distance between the middles of two actors."""
    return hypot(one.x_m - other.x_m, one.y_m - other.y_m)


def sorted_by_name(states: Sequence[State]) -> tuple[State, ...]:
    """Return states in the order in which partners always get them."""
    return tuple(sorted(states, key=lambda state: state.name))
