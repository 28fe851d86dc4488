"""Tests of cars, walkers and measures at a road, against laws and numbers worked out by hand."""

import time
from math import pi, sqrt

import numpy as np
import pytest

from app.science.cosimulation import (
    Cars,
    Clocks,
    Conductor,
    CosimulationError,
    Departure,
    Driver,
    Lateness,
    Partner,
    Record,
    RecordedPath,
    Road,
    Row,
    State,
    Walker,
    WalkerPlan,
    crossings,
    crossings_of,
)
from app.science.cosimulation.cars import commanded_m_s2
from app.science.walking.records import PlannedPath

STEP_S = 0.02
ROAD, STREET = Road(), Road(crossing_width_m=None)
VECTOR = np.array([1.4, 1.0, 1.5])


def _run(*partners: Partner, seconds: float) -> Record:
    together = [(one, Lateness()) for one in partners]
    conductor = Conductor(together, STEP_S, Clocks(time.perf_counter))
    return conductor.run(round(seconds / STEP_S), {})[0]


def _standing(x_m: float, y_m: float, then: tuple[float, float] | None = None) -> RecordedPath:
    """Return a person who stands in one place, or steps to another between 4 and 6 s."""
    times = np.array([0.0, 4.0, 6.0])
    ends = then or (x_m, y_m)
    return RecordedPath("p", STEP_S, times, np.array([[x_m, y_m], [x_m, y_m], ends]))


def _cars(road: Road, *departures: Departure) -> Cars:
    return Cars("cars", STEP_S, road, departures, Driver(speed_m_s=12.0))


def _car(x_m: float, speed_m_s: float, lane_y_m: float = -1.6, name: str = "car") -> State:
    heading = 0.0 if lane_y_m < 0 else pi
    return State(name, "car", 0.0, x_m, lane_y_m, heading, speed_m_s, 0.0, 4.5, 1.8)


def _person(x_m: float, y_m: float, speed_m_s: float = 0.0, heading: float = pi / 2) -> State:
    return State("p", "person", 0.0, x_m, y_m, heading, speed_m_s, 0.0, 0.5, 0.5)


def test_a_driver_keeps_the_model_s_equilibrium_gap() -> None:
    """At equal speeds nobody accelerates at s = (s0 + v T) / sqrt(1 - (v / v0)^4), Treiber 2000."""
    driver, speed = Driver(speed_m_s=12.0), 8.0
    gap_m = (driver.gap_m + speed * driver.headway_s) / sqrt(1.0 - (speed / 12.0) ** 4)
    ahead = _car(gap_m + 4.5, speed, name="ahead")
    assert commanded_m_s2(_car(0.0, speed), [ahead], ROAD, driver) == pytest.approx(0.0, abs=1e-12)
    # A car in the other lane and one behind are no matter.
    free = commanded_m_s2(_car(0.0, speed), [], ROAD, driver)
    others = [_car(20.0, speed, 1.6, "a"), _car(-10.0, speed, name="b")]
    assert commanded_m_s2(_car(0.0, speed), others, ROAD, driver) == free


@pytest.mark.parametrize(("road", "x_m"), [(ROAD, 0.0), (ROAD, -30.0), (STREET, 0.0)])
def test_a_car_stops_for_a_person_on_the_crossing_and_off_it(road: Road, x_m: float) -> None:
    """Somebody who steps in front of it is waited for, wherever that is; nobody is hit."""
    plan = Departure("car", "near", 0.0, 12.0)
    record = _run(_standing(x_m, -4.0, (x_m, -1.6)), _cars(road, plan), seconds=20.0)
    car = next(row.state for row in record.steps[-1] if row.state.kind == "car")
    front_m = car.x_m + car.length_m / 2.0
    assert car.speed_m_s < 0.05
    assert 1.0 < x_m - 0.25 - front_m < 3.0
    assert crossings(record, road)[0].collision is None


def test_cars_give_way_to_those_who_wait_only_at_a_crossing() -> None:
    """A person at the kerb stops a car at the crossing; on the pavement or a plain street not."""
    plan = Departure("car", "near", 0.0, 12.0)

    def slowest(road: Road, x_m: float, y_m: float) -> float:
        record = _run(_standing(x_m, y_m), _cars(road, plan), seconds=16.0)
        cars = [row.state for rows in record.steps for row in rows if row.state.kind == "car"]
        return min(car.speed_m_s for car in cars)

    assert slowest(ROAD, 0.0, -3.7) < 0.05
    assert slowest(ROAD, 0.0, -5.0) > 11.9
    assert slowest(ROAD, -30.0, -3.7) > 11.9
    assert slowest(STREET, 0.0, -3.7) > 11.9


def test_a_walker_refuses_short_gaps_and_takes_the_first_long_one() -> None:
    """Cars 3 s apart are let pass; after the last one, the walker of the model crosses at once."""
    plan = WalkerPlan(PlannedPath(np.array([[0, -5.2], [0, 5.2]])), VECTOR, 6.0, accepts_s=5.0)
    cars = _cars(STREET, *(Departure(f"car-{n}", "near", 3.0 * n, 12.0) for n in range(4)))
    record = _run(Walker("w", STEP_S, plan, STREET), cars, seconds=30.0)
    found = crossings(record, STREET)[0]
    last = [row.state for rows in record.steps for row in rows if row.state.name == "car-3"]
    passed_s = next(one.time_s for one in last if one.x_m > 4.5 / 2.0 + 0.25)
    assert found.steps_on_s is not None
    assert found.steps_off_s is not None
    assert 0.8 < found.steps_on_s - passed_s < 1.0
    assert found.gap_accepted_s is None
    assert found.gaps_refused_s == pytest.approx([3.2] * 3, abs=0.3)
    # At 1 m/s^2 the 0.4 m to the kerb take 0.89 s; 1.4 m/s are reached after 1.4 s and 0.98 m, and
    # the other 5.82 m to the far kerb take 4.16 s.
    assert found.steps_off_s - found.steps_on_s == pytest.approx(1.4 - 0.89 + 4.16, abs=0.05)
    assert found.waited_s > 10.0
    with pytest.raises(CosimulationError, match=r"must begin more than 3\.6 m"):
        Walker("w", STEP_S, WalkerPlan(PlannedPath(np.array([[0, 0], [0, 5.2]])), VECTOR), STREET)


def _record(*frames: tuple[State, ...]) -> Record:
    steps = tuple(tuple(Row("x", "said", one) for one in states) for states in frames)
    return Record({}, 0.5, steps, (), "")


def _at(state: State, time_s: float, **values: float) -> State:
    return State(**{**state.__dict__, "time_s": time_s, **values})


def test_margins_are_those_worked_out_by_hand() -> None:
    """Gap, time to collision, post-encroachment time and closest distance of one encounter."""
    frames = []
    for number in range(17):
        t = 0.5 * number
        person = _at(_person(0.0, -3.7 + max(0.0, t - 1.0) * 1.0, 1.0 if t > 1.0 else 0.0), t)
        frames.append((person, _at(_car(-62.0 + 10.0 * t, 10.0), t)))
    found = crossings(_record(*frames), STREET)[0]
    # The person stands until 1 s and steps on at 2 s (y = -2.7). The front is then at -39.75, and
    # the person reaches .25 m towards it: 39.5 m at 10 m/s.
    assert found.steps_on_s == 2.0
    assert found.gap_accepted_s == pytest.approx(3.95)
    assert found.waited_s == 1.5
    # Both use the strip until y = -0.45, that is at 4 s (y = -0.7) in these samples; the car's
    # front reaches it at 5.95 s, that is at 6 s.
    assert found.least_post_encroachment_s == pytest.approx(2.0)
    # At 1 m/s the person is out of the car's way before it comes: no collision course at all.
    assert found.least_time_to_collision_s is None
    assert found.collision is None


def test_who_sways_at_the_kerb_steps_over_it_once() -> None:
    """Kerbs are at 3.2 m: 5 cm over the edge and back is no crossing, neither before nor after."""
    sways = (-4.0, -3.15, -3.25, -3.1, 0.0, 3.15, 3.25, 3.15, 3.3, 3.5, 3.15, 3.3, 3.5)
    frames = [(_at(_person(0.0, y_m), 0.5 * number),) for number, y_m in enumerate(sways)]
    (found,) = crossings_of(_record(*frames), STREET, "p")
    # The last steps over the edges before the person was clearly past them.
    assert (found.steps_on_s, found.steps_off_s, found.is_across) == (1.5, 4.0, True)
    turned = [(_at(_person(0.0, y_m), 0.5 * n),) for n, y_m in enumerate((-4, -2.9, -3.3, -4))]
    (back,) = crossings_of(_record(*turned), STREET, "p")
    assert (back.steps_on_s, back.steps_off_s, back.is_across) == (0.5, 1.0, False)


def test_a_collision_is_found_with_its_speed() -> None:
    """A person who stays in the lane is hit; until then the time to collision counts down."""
    frames = [
        (_at(_person(0.0, -1.6), 0.5 * n), _at(_car(-22.0 + 5.0 * n, 10.0), 0.5 * n))
        for n in range(6)
    ]
    found = crossings(_record(*frames), ROAD)[0]
    # At first the front is 19.75 m away, less .25 m of the person, at 10 m/s.
    assert found.gap_accepted_s == pytest.approx(1.95)
    assert found.least_time_to_collision_s == 0.0
    assert found.least_post_encroachment_s == 0.0
    assert found.closest_m == 0.0
    assert found.collision is not None
    assert (found.collision.time_s, found.collision.car_speed_m_s) == (2.0, 10.0)
