"""Cars with a driver of our own: traffic without another engine, and the example of a vehicle.

The driver follows the intelligent driver model and gives way: to persons on the carriageway ahead,
on the crossing or off it, and to persons who wait at the crossing if that needs only comfortable
braking. The driver commands an acceleration; what the car makes of it is a `Dynamics` of its own.

Source: Treiber, Hennecke and Helbing (2000), "Congested traffic states in empirical observations
and microscopic simulations", equations 2 and 3. The parameters are plausible for a town and fitted
to nothing.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf, sin, sqrt
from typing import Protocol

from app.science.cosimulation.partners import InProcess, Request
from app.science.cosimulation.road import (
    STOPPED_M_S,
    Departure,
    Lane,
    Road,
    direction_of,
    heading_of,
)
from app.science.cosimulation.states import State

CAR_M = (4.5, 1.8)
"""Length and width of a car."""


@dataclass(frozen=True)
class Driver:
    """The parameters of a driver.

    Attributes:
        speed_m_s: wanted speed.
        headway_s, gap_m: kept to what is ahead: time, and distance when standing.
        acceleration_m_s2: largest acceleration.
        comfortable_m_s2: braking that is used without need.
        hardest_m_s2: braking in an emergency.
        waits_m: a person this close behind the kerb of the crossing is given way to.
        beside_m: free width to each side of the car that a person may stand in unheeded.
    """

    speed_m_s: float = 12.0
    headway_s: float = 1.2
    gap_m: float = 2.0
    acceleration_m_s2: float = 1.5
    comfortable_m_s2: float = 2.0
    hardest_m_s2: float = 8.0
    waits_m: float = 1.0
    beside_m: float = 0.5


def commanded_m_s2(car: State, others: Iterable[State], road: Road, driver: Driver) -> float:
    """Return the acceleration that a driver wants, m/s^2.

    The smallest of what a free road, the car ahead and each person ahead allow; a person is an
    obstacle that stands.
    """
    wanted = _free(car, driver)
    for other in others:
        if other.name == car.name:
            continue
        obstacle = _ahead(car, other, road, driver)
        if obstacle is not None:
            wanted = min(wanted, _behind(car, *obstacle, driver))
    return max(-driver.hardest_m_s2, wanted)


def _free(car: State, driver: Driver) -> float:
    return driver.acceleration_m_s2 * (1.0 - (car.speed_m_s / driver.speed_m_s) ** 4)


def _behind(car: State, gap_m: float, speed_m_s: float, driver: Driver) -> float:
    """Return the model's acceleration behind an obstacle (equations 2 and 3)."""
    closing = car.speed_m_s - speed_m_s
    braking = 2.0 * sqrt(driver.acceleration_m_s2 * driver.comfortable_m_s2)
    dynamic_m = car.speed_m_s * driver.headway_s + car.speed_m_s * closing / braking
    wanted_m = driver.gap_m + max(0.0, dynamic_m)
    share = wanted_m / max(gap_m, 0.1)
    return _free(car, driver) - driver.acceleration_m_s2 * share**2


def _ahead(car: State, other: State, road: Road, driver: Driver) -> tuple[float, float] | None:
    """Return the free distance to another actor and its speed along the lane; None if no matter."""
    direction = direction_of(car)
    along_m = (other.x_m - car.x_m) * direction - car.length_m / 2.0
    if other.kind == "car":
        same = direction_of(other) == direction and abs(other.y_m - car.y_m) < car.width_m
        gap_m = along_m - other.length_m / 2.0
        return (gap_m, other.speed_m_s) if same and along_m > -car.length_m / 2.0 else None
    gap_m = along_m - other.width_m / 2.0
    if along_m < 0.0:
        return None
    if road.is_on_carriageway(other):
        return (gap_m, 0.0) if _in_the_way(car, other, driver) else None
    if road.is_at_crossing(other) and abs(other.y_m) <= road.lane_width_m + driver.waits_m:
        leaves = other.speed_m_s > STOPPED_M_S and _away(other, 0.0) > 0.0
        needs = car.speed_m_s**2 / (2.0 * max(gap_m - driver.gap_m, 0.1))
        if not leaves and needs <= 1.5 * driver.comfortable_m_s2:
            return gap_m, 0.0
    return None


def _in_the_way(car: State, person: State, driver: Driver) -> bool:
    """Whether a person on the carriageway is in the car's strip of it, or not walking away."""
    in_strip = abs(person.y_m - car.y_m) <= (car.width_m + person.width_m) / 2.0 + driver.beside_m
    return in_strip or _away(person, car.y_m) <= STOPPED_M_S


def _away(person: State, y_m: float) -> float:
    """Return the speed at which a person moves away from a line along the road, m/s."""
    side = 1.0 if person.y_m > y_m else -1.0
    return side * person.speed_m_s * sin(person.heading_rad)


class Dynamics(Protocol):
    """Protocol of a car's movement along its lane."""

    def step(self, acceleration_m_s2: float, dt_s: float) -> tuple[float, float]:
        """Advance by a step; return the distance driven since the start, m, and the speed, m/s."""
        ...


class PointMass:
    """A car that does at once what its driver wants, and never rolls back."""

    def __init__(self, speed_m_s: float) -> None:
        self._driven_m, self._speed_m_s = 0.0, speed_m_s

    def step(self, acceleration_m_s2: float, dt_s: float) -> tuple[float, float]:
        """Advance with constant acceleration, until it stands."""
        before = self._speed_m_s
        after = before + acceleration_m_s2 * dt_s
        if after >= 0.0:
            self._driven_m += (before + after) / 2.0 * dt_s
        else:
            self._driven_m += before**2 / (-2.0 * acceleration_m_s2)
            after = 0.0
        self._speed_m_s = after
        return self._driven_m, after


class DrivenCar:
    """One car with its driver, from the beginning of a lane to its end."""

    def __init__(self, plan: Departure, road: Road, driver: Driver, dynamics: Dynamics) -> None:
        self._name, self._road, self._driver, self._dynamics = plan.name, road, driver, dynamics
        self._direction = road.direction(plan.lane)
        self._y_m = road.middle_m(plan.lane)
        self._begins_m = -self._direction * road.half_length_m
        self.state = self._at(plan.time_s, 0.0, plan.speed_m_s)

    def _at(self, time_s: float, driven_m: float, speed_m_s: float) -> State:
        x_m = self._begins_m + self._direction * driven_m
        heading = heading_of(self._direction)
        where = (x_m, self._y_m, heading)
        return State(self._name, "car", time_s, *where, speed_m_s, 0.0, *CAR_M)

    @property
    def has_left(self) -> bool:
        """Whether it is beyond the end of the road."""
        return self.state.x_m * self._direction > self._road.half_length_m

    def advance(self, others: Sequence[State], from_s: float, to_s: float) -> State:
        """Drive one step among others, who are where they were at its beginning."""
        wanted = commanded_m_s2(self.state, others, self._road, self._driver)
        self.state = self._at(to_s, *self._dynamics.step(wanted, to_s - from_s))
        return self.state


class Cars(InProcess):
    """A partner: cars that enter the road at their times, each with the same driver."""

    def __init__(
        self, name: str, step_s: float, road: Road, plan: Sequence[Departure], driver: Driver
    ) -> None:
        super().__init__(name, step_s)
        self._road, self._driver = road, driver
        self._to_come = list(plan)
        self._cars: list[DrivenCar] = []

    def start(self) -> tuple[State, ...]:
        """Return the cars that enter at 0 s."""
        return self._after(0.0)

    def advance(self, request: Request) -> tuple[State, ...]:
        """Drive all cars, each among the others where they were at the step's beginning."""
        everybody = [*request.others, *(car.state for car in self._cars)]
        for car in self._cars:
            car.advance(everybody, request.from_s, request.to_s)
        return self._after(request.to_s)

    def _after(self, time_s: float) -> tuple[State, ...]:
        """Let cars leave, and enter where there is room."""
        self._cars = [car for car in self._cars if not car.has_left]
        waiting: list[Departure] = []
        for one in self._to_come:
            if one.time_s > time_s + 1e-9 or self._room_m(one.lane) < 2.0 * CAR_M[0]:
                waiting.append(one)
                continue
            entering = replace(one, time_s=time_s)
            dynamics = PointMass(one.speed_m_s)
            self._cars.append(DrivenCar(entering, self._road, self._driver, dynamics))
        self._to_come = waiting
        return tuple(car.state for car in self._cars)

    def _room_m(self, lane: Lane) -> float:
        """Return how far the last car of a lane is from its beginning."""
        direction, begins = self._road.direction(lane), self._road.half_length_m
        inside = [
            car.state.x_m * direction + begins
            for car in self._cars
            if direction_of(car.state) == direction
        ]
        return min(inside, default=inf)
