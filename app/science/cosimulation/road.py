"""A straight road with kerbs on both sides and, if there is one, a crossing in its middle.

It runs along x, with its middle line at y = 0 and the crossing at x = 0. Traffic keeps to the
right: the near lane (y < 0) leads towards +x, the far lane towards -x.
"""

from dataclasses import dataclass
from math import inf, pi
from typing import Literal

import numpy as np

from app.science.cosimulation.states import CosimulationError, State

Lane = Literal["near", "far"]
STOPPED_M_S = 0.1
"""A slower car counts as standing."""


@dataclass(frozen=True)
class Road:
    """The road's sizes.

    Attributes:
        half_length_m: from the crossing to either end.
        lane_width_m: of each of the two lanes; the kerbs are at y = -lane_width_m and +.
        pavement_width_m: of the pavement behind each kerb.
        speed_limit_m_s: of the road.
        crossing_width_m: of the crossing, where cars give way; None without a crossing.
    """

    half_length_m: float = 120.0
    lane_width_m: float = 3.2
    pavement_width_m: float = 2.0
    speed_limit_m_s: float = 13.9
    crossing_width_m: float | None = 4.0

    def direction(self, lane: Lane) -> int:
        """Return 1 for the lane towards +x, -1 for the other."""
        return 1 if lane == "near" else -1

    def middle_m(self, lane: Lane) -> float:
        """Return y of a lane's middle line."""
        return -self.direction(lane) * self.lane_width_m / 2.0

    def is_on_carriageway(self, state: State) -> bool:
        """Whether an actor's middle is between the kerbs."""
        return abs(state.y_m) < self.lane_width_m

    def is_at_crossing(self, state: State) -> bool:
        """Whether an actor is as far along the road as the crossing, or half a metre beside it."""
        return self.crossing_width_m is not None and (
            abs(state.x_m) <= self.crossing_width_m / 2.0 + 0.5
        )


@dataclass(frozen=True)
class Departure:
    """A car that enters the road at the beginning of a lane."""

    name: str
    lane: Lane
    time_s: float
    speed_m_s: float


@dataclass(frozen=True)
class Flow:
    """Cars that enter a lane one after the other.

    Attributes:
        lane: near or far.
        first_s: when the first one enters.
        headway_s: time between two; the mean of them with `spread`.
        count: number of cars.
        speed_m_s: at which they enter.
        spread: whether headways are random: `least_s` and an exponentially distributed rest.
        least_s: smallest headway of a random flow.
    """

    lane: Lane
    first_s: float
    headway_s: float
    count: int
    speed_m_s: float
    spread: bool = False
    least_s: float = 1.5


def departures(name: str, flows: tuple[Flow, ...], rng: np.random.Generator) -> list[Departure]:
    """Return the cars of a partner's flows by time; `NAME-near-1` is the first of its lane.

    Source of the random headways: the shifted exponential distribution; Luttinen (1996),
    "Statistical Analysis of Vehicle Time Headways", chapter 3.

    Raises:
        CosimulationError: a random flow's mean headway is not above its smallest one.
    """
    found: list[Departure] = []
    for flow in flows:
        if flow.spread and flow.headway_s <= flow.least_s:
            raise CosimulationError(
                f"Headways of {flow.headway_s:g} s on average cannot all be above"
                f" {flow.least_s:g} s."
            )
        at_s = flow.first_s
        for _ in range(flow.count):
            number = 1 + sum(one.lane == flow.lane for one in found)
            label = f"{name}-{flow.lane}-{number}"
            found.append(Departure(label, flow.lane, round(at_s, 3), flow.speed_m_s))
            rest_s = flow.headway_s - flow.least_s
            random_s = flow.least_s + rest_s * float(rng.exponential())
            at_s += random_s if flow.spread else flow.headway_s
    return sorted(found, key=lambda one: (one.time_s, one.name))


def heading_of(direction: int) -> float:
    """Return the heading of a car that drives towards +x (1) or -x (-1)."""
    return 0.0 if direction > 0 else pi


def direction_of(state: State) -> int:
    """Return 1 for an actor that faces towards +x, -1 for the other way."""
    return 1 if abs(state.heading_rad) < pi / 2.0 else -1


def arrival_s(car: State, x_m: float, half_width_m: float) -> float:
    """Return when a car reaches somebody at x if it keeps its speed, from now.

    Returns:
        0 while it is beside them, infinity if it has passed or stands.
    """
    direction = direction_of(car)
    ahead_m = (x_m - car.x_m) * direction
    reach_m = car.length_m / 2.0 + half_width_m
    if ahead_m < -reach_m:
        return inf
    if ahead_m <= reach_m:
        return 0.0
    return (ahead_m - reach_m) / car.speed_m_s if car.speed_m_s > STOPPED_M_S else inf
